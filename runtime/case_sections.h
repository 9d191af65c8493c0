// The parts of read_case(), one function per section of the file. Each reads its tables, checks them against what was
// read before, and refuses keys it does not know. Order: as declared.
#pragma once

#include "runtime/case.h"
#include "runtime/case_table.h"

namespace scree {

void read_settings(TableReader& top, Case& c);   // title, seed, gravity, [contact], [neighbour], [watch] ...
void read_materials(TableReader& top, Case& c);  // [[material]]
void read_particles(TableReader& top, Case& c);  // [[particles]]
void read_regions(TableReader& top, Case& c);    // [[region]]
void read_outlets(TableReader& top, Case& c);    // [[outlet]]
void read_meters(TableReader& top, Case& c);     // [[meter]]
void read_solid(TableReader& top, Case& c);      // [lattice], [[fibres]], [[wall]]; fits [domain] to them
void read_pairs(TableReader& top, Case& c);      // [[pair]]: all that can touch
void read_time(TableReader& top, Case& c);       // [time]
void read_stages(TableReader& top, Case& c);     // [[stage]]
void read_observers(TableReader& top, Case& c);  // what is under [output]

// What read_observers() calls; they need the lattice, the stages and the time step.
void read_averages(TableReader& output, Case& c);  // [[output.average]]
void read_touch(TableReader& output, Case& c);     // [output.touch]

// [domain], once the bounds of all static things are known (planes apart, which are cut to the domain).
void read_domain(TableReader& top, Case& c, const Bounds& things);

// Names of things, for look-ups.
template <class T>
std::vector<std::string> names_of(const std::vector<T>& things) {
  std::vector<std::string> names;
  for (const T& thing : things) names.push_back(thing.name);
  return names;
}

// Reads `name` and refuses one that `names` has already.
std::string new_name(TableReader& table, const std::string& what, const std::vector<std::string>& names);

std::string path_beside(const TableReader& table, const std::string& key, const std::string& file);

}  // namespace scree
