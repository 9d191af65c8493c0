// What is said of each particle in a field file, each field in one row of a table.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/array.h"
#include "runtime/case.h"
#include "runtime/engine.h"
#include "runtime/vtkhdf_file.h"

namespace scree {

// The fields that a case may name, in the order of the files: velocity, angular_velocity, force, coordination,
// wall_contacts, contact_stress, age.
std::vector<std::string> particle_field_names();

// What a snapshot can hold, in the same order: those, mass (kg; files leave it out: radius and kind tell it) and kind.
struct ParticleFieldForm {
  std::string name;
  int components;
};
std::vector<ParticleFieldForm> particle_field_forms();

// A copy of a moment. SI units, numbers of single precision, in the engine's order of storage:
//   Points             m; double where single precision would move a particle by more than 1e-4 of its radius
//   id, kind           kinds count in the case's order, from 0
//   radius             m
//   velocity           m/s, half a time step behind the positions; angular_velocity rad/s
//   force, coordination, wall_contacts, contact_stress    as in runtime/engine.h, ContactSum: N, Pa (xx yy zz xy yz xz)
//   age                s since the particle was inserted
// What comes from contacts is not a number (counts: -1) while the engine does not know its contacts.
class ParticleSnapshot {
 public:
  ParticleSnapshot(const Case& c, const Engine& engine, const std::vector<std::string>& fields);

  // Values of the field `name` as they are written, row after row.
  struct Column {
    std::string name;
    ElementType type{};
    uint64_t components = 0;  // 0: a plain list
    Array<char> values;
    uint64_t size() const { return values.capacity() / type.size; }
  };
  size_t particles() const { return particles_; }
  const std::vector<Column>& columns() const { return columns_; }  // the first is Points
  std::vector<Column> take() && { return std::move(columns_); }    // them

 private:
  size_t particles_;
  std::vector<Column> columns_;
};

// The arrays of a field file, packed on all threads. Of a snapshot, in one loop, and something else in it; or of this
// moment, some particles after the others, so that what they are packed of is never there for all. The same bytes.
std::vector<PackedArray> packed_particles(const ParticleSnapshot& snapshot, const std::function<void()>& beside = {});
std::vector<PackedArray> packed_particles(const Case& c, const Engine& engine, const std::vector<std::string>& fields);

}  // namespace scree
