// Wrong case files: each row edits the good case in one place and states the error. '@' in the edit marks where the
// error must point, to the line and column; without it the error is about something that is not there.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/case_reader.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

struct Wrong {
  const char* what;
  const char* find;      // once in the good case; empty: the edit goes to the end of the file
  const char* edit;      // what replaces it
  const char* expected;  // part of the message
};

// clang-format off
const Wrong kWrong[] = {
    // TOML itself
    {"syntax", "seed = 7", "seed = = 7", "case.toml:2:8: not valid TOML"},
    {"a key twice", "seed = 7", "seed = 7\nseed = 8", "case.toml:3:8: not valid TOML: Error while parsing key-value pair: cannot redefine existing integer 'seed'"},
    {"an open string", "title = \"good\"", "title = \"good", "case.toml:1:"},
    {"a date", "seed = 7", "seed = @2024-01-01", "a date or time means nothing"},
    // unknown and missing keys
    {"unknown top key", "seed = 7", "@sede = 7", "key 'sede': unknown key (value 7), known here: "},
    {"and its neighbour", "seed = 7", "@sede = 7", "; did you mean 'seed'?"},
    {"unknown table", "[output]", "[@outputs]", "key 'outputs': unknown key"},
    {"unknown key in a table", "rolling = \"epsd2\"", "@roling = \"epsd2\"", "key 'contact.roling': unknown key (value \"epsd2\")"},
    {"misspelt required key", "density = 3071\nyoungs_modulus", "density = 3071\n@young_modulus", "key 'material.bead.young_modulus': unknown key (value 10000000.0), known here: name, density, youngs_modulus; did you mean 'youngs_modulus'?"},
    {"key of another wall kind", "z = [20e-3, 44e-3]", "z = [20e-3, 44e-3]\n@radius = 1", "key 'wall.hopper.radius': unknown key (value 1)"},
    {"misspelt particles", "[[particles]]", "[[@particle]]", "did you mean 'particles'?"},
    {"missing density key", "poisson_ratio = 0.28\n", "", "key 'material.bead.poisson_ratio': is missing"},
    {"missing diameter", "diameter = 400e-6\n", "", "key 'particles.grain.diameter': is missing, give one of: diameter, distribution"},
    {"missing fibre diameter", "fibre_diameter = 1.0e-3\n", "", "key 'lattice.fibre_diameter': is missing, give one of: fibre_diameter, porosity"},
    // types
    {"string for a number", "density = 3071", "density = @\"3071\"", "key 'material.bead.density': \"3071\" is of the wrong type, must be a number, between 10 and 100000 kg/m3"},
    {"number for a string", "title = \"good\"", "title = @3", "key 'title': 3 is of the wrong type, must be a string"},
    {"number for a flag", "[time]", "[time]\nallow_large_step = @1", "key 'time.allow_large_step': 1 is of the wrong type, must be true or false"},
    {"fraction for a whole number", "seed = 7", "seed = @7.5", "key 'seed': 7.5 is of the wrong type, must be a whole number"},
    {"two numbers for a vector", "gravity = [0, 0, -9.81]", "gravity = @[0, -9.81]", "key 'gravity': [0, -9.81] has 2 entries, must be a list of 3 numbers"},
    {"a word in a vector", "gravity = [0, 0, -9.81]", "gravity = [0, 0, @\"down\"]", "key 'gravity': \"down\" is of the wrong type"},
    {"a table for tables", "[[outlet]]", "@[outlet]", "key 'outlet': {name = \"exit\", point = [0, 0, 0]} is of the wrong type, must be tables, each under [[outlet]]"},
    {"half a cell", "cells = [1, 1, 2]", "cells = @[1, 1, 2.5]", "key 'lattice.cells': [1, 1, 2.5] is of the wrong type, must be a list of 3 whole numbers"},
    // ranges
    {"density in g/cm3", "density = 3071", "density = @3.071", "key 'material.bead.density': 3.071 is out of range, must be between 10 and 100000 kg/m3"},
    {"modulus in GPa", "density = 3071\nyoungs_modulus = 1e7", "density = 3071\nyoungs_modulus = @209", "key 'material.bead.youngs_modulus': 209 is out of range, must be between 1000 and 1e+13 Pa"},
    {"Poisson's ratio", "poisson_ratio = 0.28", "poisson_ratio = @0.6", "must be greater than -1 and at most 0.5"},
    {"restitution", "restitution = 0.52", "restitution = @1.2", "key 'pair.bead+bead.restitution': 1.2 is out of range, must be between 0 and 1"},
    {"negative friction", "sliding_friction = 0.53", "sliding_friction = @-0.1", "key 'pair.bead+bead.sliding_friction': -0.1 is out of range, must be between 0 and 10"},
    {"diameter in um", "diameter = 400e-6", "diameter = @400", "key 'particles.grain.diameter': 400 is out of range, must be between 1e-07 and 10 m"},
    {"not a number", "restitution = 0.52", "restitution = @nan", "key 'pair.bead+bead.restitution': nan is out of range"},
    {"infinite", "gravity = [0, 0, -9.81]", "gravity = [0, 0, @-inf]", "key 'gravity': -inf is out of range, must be between -1000 and 1000 m/s2"},
    {"negative interval", "interval = 1e-3", "interval = @-1e-3", "key 'output.interval': -0.001 is out of range, must be greater than 0 and at most 1e+06 s"},
    {"negative seed", "seed = 7", "seed = @-7", "key 'seed': -7 is out of range"},
    {"zero time step", "step = 5e-6", "step = @0", "key 'time.step': 0 is out of range, must be between 1e-15 and 1 s"},
    {"an overlap of nothing", "[output]", "[watch]\nmax_overlap = @0\n[output]", "key 'watch.max_overlap': 0 is out of range, must be greater than 0 and at most 0.5 of the radii' sum, at walls of the radius"},
    {"an overlap beyond the limit", "[output]", "[watch]\nmax_overlap = @0.6\n[output]", "key 'watch.max_overlap': 0.6 is out of range, must be greater than 0 and at most 0.5 of the radii' sum, at walls of the radius"},
    {"an unknown key of the watch", "[output]", "[watch]\n@max_overlaps = 0.1\n[output]", "key 'watch.max_overlaps': unknown key (value 0.1), known here: max_overlap; did you mean 'max_overlap'?"},
    {"step above half the Rayleigh time", "step = 5e-6", "step = @2e-5", "2e-05 s is 1.05 of the smallest Rayleigh time, must be at most 0.5 of it"},
    {"large Rayleigh fraction", "step = 5e-6", "rayleigh_fraction = @0.6", "key 'time.rayleigh_fraction': 0.6 is out of range, must be between 0.0001 and 0.5 Rayleigh times"},
    {"porosity in percent", "fibre_diameter = 1.0e-3", "porosity = @88", "key 'lattice.porosity': 88 is out of range, must be greater than 0 and at most 0.9999"},
    {"fibres thicker than the cell", "fibre_diameter = 1.0e-3", "fibre_diameter = @10e-3", "key 'lattice.fibre_diameter': 0.01 m must be less than cell_size = 0.01 m"},
    {"no cells", "cells = [1, 1, 2]", "cells = [1, @0, 2]", "key 'lattice.cells': 0 is out of range, must be between 1 and 10000 cells"},
    {"solid fraction", "mass = 1e-3", "mass = 1e-3\nsolid_fraction = @0.8", "key 'stage.fill.solid_fraction': 0.8 is out of range, must be greater than 0 and at most 0.6"},
    // contradictions inside a table
    {"step and Rayleigh fraction", "step = 5e-6", "step = 5e-6\nrayleigh_fraction = @0.2", "key 'time.rayleigh_fraction': 0.2 contradicts 'step' = 5e-06, give only one of: step, rayleigh_fraction"},
    {"fibre diameter and porosity", "fibre_diameter = 1.0e-3", "fibre_diameter = 1.0e-3\nporosity = @0.88", "key 'lattice.porosity': 0.88 contradicts 'fibre_diameter' = 0.001"},
    {"mass and count", "mass = 1e-3", "mass = 1e-3\ncount = @100", "key 'stage.fill.count': 100 contradicts 'mass' = 0.001, give only one of: mass, count"},
    {"diameter and distribution", "diameter = 400e-6", "diameter = 400e-6\ndistribution = @{kind = \"list\"}", "key 'particles.grain.distribution': {kind = \"list\"} contradicts 'diameter'"},
    {"box upside down", "max = [4e-3, 4e-3, 40e-3]", "max = @[4e-3, 4e-3, 20e-3]", "key 'region.inside.max': [0.004, 0.004, 0.02] is not above min = [-0.004, -0.004, 0.021] along z"},
    {"rectangle with a volume", "max = [5e-3, 5e-3, 20e-3]\n\n[[region]]", "max = @[5e-3, 5e-3, 21e-3]\n\n[[region]]", "key 'wall.lid.max': [0.005, 0.005, 0.021]"},
    {"frustum upside down", "z = [20e-3, 44e-3]", "z = @[44e-3, 20e-3]", "key 'wall.hopper.z': [0.044, 0.02] must be [bottom, top]"},
    {"steady window", "interval = 1e-3", "interval = 1e-3\nsteady_window = @[2, 1]", "key 'output.steady_window': [2, 1] ends before it begins"},
    {"no direction", "point = [0, 0, 0]", "point = [0, 0, 0]\ndirection = @[0, 0, 0]", "key 'outlet.exit.direction': [0, 0, 0] has no direction"},
    // names
    {"unknown choice", "rolling = \"epsd2\"", "rolling = @\"epsd\"", "key 'contact.rolling': unknown value 'epsd', known: none, cdt, epsd2; did you mean 'epsd2'?"},
    {"unknown wall kind", "kind = \"frustum\"", "kind = @\"frustrum\"", "key 'wall.hopper.kind': unknown value 'frustrum'"},
    {"unknown material", "material = \"bead\"", "material = @\"beads\"", "key 'particles.grain.material': unknown material 'beads', known: bead, steel; did you mean 'bead'?"},
    {"material without density", "material = \"bead\"", "material = @\"steel\"", "key 'particles.grain.material': material \"steel\" has no density"},
    {"unknown region", "regions = [\"inside\"]", "regions = @[\"inisde\"]", "key 'stage.fill.regions': unknown region 'inisde', known: inside; did you mean 'inside'?"},
    {"unknown kind of particle", "mass = 1e-3", "mass = 1e-3\nparticles = @\"grains\"", "key 'stage.fill.particles': unknown particle kind 'grains', known: grain; did you mean 'grain'?"},
    {"two materials of a name", "name = \"steel\"", "name = @\"bead\"", "key 'material.bead.name': there are two materials named 'bead'"},
    {"two walls of a name", "name = \"lid\"", "name = @\"hopper\"", "there are two walls named 'hopper'"},
    {"a wall named as the lattice", "name = \"lid\"", "name = @\"lattice\"", "there are two walls named 'lattice'"},
    {"two stages of a name", "time = 0.1", "time = 0.1\nname = @\"fill\"", "there are two stages named 'fill'"},
    {"a name with a blank", "name = \"grain\"", "name = @\"big grain\"", "'big grain' is not a name, must be made of letters, digits, _ and -"},
    {"an empty name", "name = \"grain\"", "name = @\"\"", "\"\" is empty"},
    {"a region named twice in a list", "regions = [\"inside\"]", "regions = [\"inside\", @\"inside\"]", "key 'stage.fill.regions': 'inside' is named twice"},
    {"an empty list", "walls = [\"lid\"]", "walls = @[]", "key 'stage.open.walls': [] is empty"},
    {"no corners", "kind = \"rectangle\"\nmin = [-5e-3, -5e-3, 20e-3]\nmax = [5e-3, 5e-3, 20e-3]", "kind = \"quad\"\ncorners = @[]", "key 'wall.lid.corners': [] is empty"},
    // pairs
    {"missing pair of particles", "materials = [\"bead\", \"bead\"]", "materials = [\"steel\", \"steel\"]", "key 'pair': the pair of materials 'bead' and 'bead' is missing, but particles 'grain' and 'grain' can touch"},
    {"missing pair with a wall", "materials = [\"bead\", \"steel\"]", "materials = [\"steel\", \"steel\"]", "key 'pair': the pair of materials 'bead' and 'steel' is missing, but particles 'grain' and wall 'lattice' can touch"},
    {"a pair twice", "materials = [\"bead\", \"steel\"]", "materials = @[\"bead\", \"bead\"]", "key 'pair.bead+bead.materials': the pair [\"bead\", \"bead\"] is given twice"},
    {"a pair of one", "materials = [\"bead\", \"steel\"]", "materials = @[\"bead\"]", "[\"bead\"] is of the wrong type, must be a list of two names"},
    {"a pair of unknown", "materials = [\"bead\", \"steel\"]", "materials = @[\"bead\", \"steal\"]", "unknown material 'steal', known: bead, steel; did you mean 'steel'?"},
    // distributions
    {"fractions that do not fit", "diameter = 400e-6", "distribution = {kind = \"list\", diameters = [1e-3, 2e-3], fractions = @[1.0]}", "key 'particles.grain.distribution.fractions': [1.0] has 1 entries, must be 2 like diameters"},
    {"fractions that sum to 0.9", "diameter = 400e-6", "distribution = {kind = \"list\", diameters = [1e-3, 2e-3], fractions = @[0.5, 0.4]}", "[0.5, 0.4] sums to 0.9, must be 1"},
    {"fractions in percent", "diameter = 400e-6", "distribution = {kind = \"list\", diameters = [1e-3, 2e-3], fractions = [@50, 50]}", "50 is out of range"},
    {"normal without truncation", "diameter = 400e-6", "distribution = {kind = \"normal\", mean = 1e-3, deviation = 1e-4, min = 1e-4}", "key 'particles.grain.distribution.max': is missing"},
    {"normal cut off", "diameter = 400e-6", "distribution = {kind = \"normal\", mean = @1e-3, deviation = 1e-4, min = 2e-3, max = 3e-3}", "key 'particles.grain.distribution.mean': 0.001 is cut off"},
    {"min above max", "diameter = 400e-6", "distribution = {kind = \"lognormal\", median = 1e-3, deviation = 0.1, min = 2e-3, max = @1e-3}", "key 'particles.grain.distribution.max': 0.001 is below min = 0.002"},
    {"a distribution cut to nothing", "diameter = 400e-6", "distribution = {kind = \"normal\", mean = 1e-3, deviation = @1.0, min = 0.9e-3, max = 1.1e-3}", "key 'particles.grain.distribution.deviation': 1.0 leaves 8e-05 of the distribution between min = 0.0009 and max = 0.0011, must be at least 0.01"},
    // sizes that no machine holds
    {"a lattice of 1e9 cells", "cells = [1, 1, 2]", "cells = @[1000, 1000, 1000]", "key 'lattice.cells': the lattice's 2.5e+10 fibres need about 3.25e+04 GB of memory, there are "},
    {"a step of nothing", "step = 5e-6", "step = @1e-300", "key 'time.step': 1e-300 is out of range, must be between 1e-15 and 1 s"},
    {"a row every femtosecond", "interval = 1e-3", "interval = @1e-15", "key 'output.interval': 1e-15 s makes 1e+14 rows of mass_flow.csv"},
    {"a fibre without length", "[[region]]", "[[fibres]]\nname = \"f\"\nmaterial = \"steel\"\ndiameter = 1e-3\nsegments = @[[0, 0, 0, 0, 0, 1e-12]]\n[[region]]", "key 'fibres.f.segments': segment 1 from [0, 0, 0] has no length, its ends must be 1e-09 m apart"},
    {"a fibre to nowhere", "[[region]]", "[[fibres]]\nname = \"f\"\nmaterial = \"steel\"\ndiameter = 1e-3\nsegments = [[0, 0, 0, 0, 0, @inf]]\n[[region]]", "key 'fibres.f.segments': inf is out of range, must be between -1000 and 1000 m"},
    {"a fibre without thickness", "[[region]]", "[[fibres]]\nname = \"f\"\nmaterial = \"steel\"\ndiameter = @0\nsegments = [[0, 0, 0, 0, 0, 1]]\n[[region]]", "key 'fibres.f.diameter': 0 is out of range, must be between 1e-07 and 10 m"},
    {"a wall without thickness of its own", "min = [-5e-3, -5e-3, 20e-3]\nmax = [5e-3, 5e-3, 20e-3]\n\n[[region]]", "min = [-5e-3, 0, 20e-3]\nmax = @[5e-3, 1e-320, 20e-3]\n\n[[region]]", "key 'wall.lid.max': "},
    // domain
    {"region outside the domain", "[[region]]\nname = \"inside\"\nshape = \"box\"", "[domain]\nmin = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.03]\n[[region]]\nname = \"inside\"\nshape = @\"box\"", "key 'region.inside.shape': region 'inside' from [-0.004, -0.004, 0.021] to [0.004, 0.004, 0.04] m is not inside the domain from [-0.1, -0.1, -0.1] to [0.1, 0.1, 0.03] m"},
    {"periodic without a domain", "", "[domain]\nperiodic = @[\"x\"]\n", "key 'domain.periodic': [\"x\"] needs the domain's size"},
    {"unknown axis", "", "[domain]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nperiodic = @[\"w\"]\n", "key 'domain.periodic': unknown axis 'w', known: x, y, z"},
    {"periodic and narrow", "", "[domain]\nmin = [-0.1, -0.0005, -0.1]\nmax = [0.1, 0.0005, 0.1]\nperiodic = @[\"y\"]\n", "the domain is 0.001 m long along periodic y, must be more than 0.0012 m"},
    {"half a domain", "", "@[domain]\nmin = [-1, -1, -1]\n", "key 'domain.max': is missing"},
    {"outlet outside the domain", "point = [0, 0, 0]", "point = @[0, 0, 0.5]\n[domain]\nmin = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.1]", "key 'outlet.exit.point': [0, 0, 0.5] is outside the domain"},
    {"outlet that removes too late", "point = [0, 0, 0]", "point = [0, 0, 0]\nremove_beyond = @0.2\n[domain]\nmin = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.1]", "key 'outlet.exit.remove_beyond': 0.2 m: the domain ends 0.1 m beyond the outlet"},
    {"meter outside the domain", "max = [5e-3, 5e-3, 20e-3]\n\n[[stage]]", "max = [5e-3, 5e-3, 20e-3]\n[[meter]]\nname = \"far\"\nmin = @[1, 1, 1]\nmax = [2, 2, 2]\n\n[[stage]]", "key 'meter.far.min': meter 'far' lies outside the domain"},
    // averages and touch maps
    {"an average without a name", "", "[[output.average]]\nspacing = 1e-3\n", "key 'output.average[1].name': is missing"},
    {"two averages of a name", "", "[[output.average]]\nname = \"a\"\n[[output.average]]\nname = @\"a\"\n", "there are two averages named 'a', names must differ"},
    {"a misspelt spacing", "", "[[output.average]]\nname = \"a\"\n@spacng = 1e-3\n", "key 'output.average.a.spacng': unknown key (value 0.001)"},
    {"an average upside down", "", "[[output.average]]\nname = \"a\"\nmin = [0, 0, 10e-3]\nmax = @[1e-3, 1e-3, 5e-3]\n", "key 'output.average.a.max': [0.001, 0.001, 0.005] is not above min = [0, 0, 0.01] along z"},
    {"an average beyond the domain", "", "[[output.average]]\nname = \"a\"\nmin = @[0, 0, -1]\nmax = [1e-3, 1e-3, 5e-3]\n", "key 'output.average.a.min': the box from [0, 0, -1] to [0.001, 0.001, 0.005] m is not inside the domain"},
    {"an average of half a box", "", "[[output.average]]\nname = \"a\"\nmin = [0, 0, 0]\n", "key 'output.average.a.max': is missing"},
    {"an average of atoms", "", "[[output.average]]\nname = \"a\"\nspacing = @1e-9\n", "cells, must be at most 1e+09"},
    {"a kernel narrower than a cell", "", "[[output.average]]\nname = \"a\"\nspacing = 1e-3\nwidth = @1e-4\n", "key 'output.average.a.width': 0.0001 m is out of range, must be between 0.001 and "},
    {"a kernel of a hundred cells", "", "[[output.average]]\nname = \"a\"\nspacing = 1e-4\nwidth = @1e-2\n", "key 'output.average.a.width': 0.01 m is out of range"},
    {"a steady average without the window", "", "[[output.average]]\nname = \"a\"\nduring = @\"steady\"\n", "key 'output.average.a.during': \"steady\" needs [output] steady_window = [from, to]"},
    {"an average during a rain", "", "[[output.average]]\nname = \"a\"\nduring = @\"rain\"\n", "unknown value 'rain', known: always, drain, steady; did you mean 'drain'?"},
    {"an average whose window ends before it begins", "", "[[output.average]]\nname = \"a\"\nwindow = @[2, 1]\n", "key 'output.average.a.window': [2, 1] ends before it begins"},
    {"a number for the default average", "interval = 1e-3", "interval = 1e-3\ndefault_average = @1", "key 'output.default_average': 1 is of the wrong type, must be true or false"},
    {"touch cells in no upper half", "", "[output.touch]\naround = @6\n", "key 'output.touch.around': 6 must be a multiple of 4"},
    {"touch cells of atoms", "", "[output.touch]\ncell = @1e-8\n", "cells, must be at most 1e+09"},
    {"touch maps of an unknown wall", "", "[output.touch]\nwalls = @[\"hoper\"]\n", "key 'output.touch.walls': unknown wall of plane faces 'hoper', known: hopper, lid; did you mean 'hopper'?"},
    {"settings of touch maps that are off", "", "[output.touch]\nenabled = false\ncell = @1e-3\n", "key 'output.touch.cell': 0.001 has no effect with enabled = false"},
    {"touch maps never looked at", "", "[output.touch]\ninterval = @0\n", "key 'output.touch.interval': 0 is out of range, must be greater than 0"},
    // stages
    {"settle before particles", "kind = \"fill\"\nregions = [\"inside\"]\nmass = 1e-3", "name = \"a\"\nkind = @\"settle\"\ntime = 1", "key 'stage.a.kind': \"settle\" before there are particles"},
    {"drain before particles", "kind = \"fill\"\nregions = [\"inside\"]\nmass = 1e-3", "name = \"a\"\nkind = @\"drain\"\nmax_time = 1", "key 'stage.a.kind': \"drain\" before there are particles"},
    {"settle without an end", "time = 0.1\n", "", "key 'stage.settle.time': is missing, give one of: time, kinetic_energy_per_particle"},
    {"settle by energy without a limit", "time = 0.1", "kinetic_energy_per_particle = 1e-12", "key 'stage.settle.max_time': is missing"},
    {"settle longer than its limit", "time = 0.1", "kinetic_energy_per_particle = 1e-12\nmax_time = 1\nmin_time = @2", "key 'stage.settle.min_time': 2 is longer than max_time = 1 s"},
    {"settle by time and by energy", "time = 0.1", "time = 0.1\nkinetic_energy_per_particle = @1e-12", "contradicts 'time' = 0.1"},
    {"drain without an end", "kind = \"drain\"\ndischarged_fraction = 0.5", "kind = @\"drain\"", "key 'stage.drain.kind': \"drain\" never ends, give one or more of: max_time (s), discharged_fraction, no_flow_time (s)"},
    {"drain without an outlet", "[[outlet]]\nname = \"exit\"\npoint = [0, 0, 0]\n", "", "key 'stage.drain.discharged_fraction': 0.5 needs an outlet to count at"},
    {"drain more than there is", "discharged_fraction = 0.5", "discharged_fraction = @1.5", "key 'stage.drain.discharged_fraction': 1.5 is out of range"},
    {"opening an unknown wall", "walls = [\"lid\"]", "walls = @[\"lit\"]", "key 'stage.open.walls': unknown wall 'lit', known: lattice, hopper, lid; did you mean 'lid'?"},
    {"opening a wall twice", "", "[[stage]]\nname = \"again\"\nkind = \"open\"\nwalls = @\"lid\"\n", "key 'stage.again.walls': wall 'lid' is open already"},
    {"two fills into one region", "mass = 1e-3", "mass = 1e-3\n[[stage]]\nname = \"more\"\nkind = \"fill\"\nregions = @[\"inside\"]\nmass = 1e-4", "key 'stage.more.regions': region 'inside' is filled already and no time passes between"},
    {"overlapping regions", "[[stage]]\nkind = \"fill\"\nregions = [\"inside\"]", "[[region]]\nname = \"b\"\nshape = \"box\"\nmin = [0, 0, 30e-3]\nmax = [5e-3, 5e-3, 35e-3]\n[[stage]]\nkind = \"fill\"\nregions = @[\"inside\", \"b\"]", "key 'stage.fill.regions': region 'b' overlaps region 'inside', which is filled already"},
    {"more than fits", "mass = 1e-3", "mass = @10", "key 'stage.fill.mass': 10 does not fit: the particles have 0.003256 m3, the regions hold at most 6.688e-07 m3 of them at solid_fraction 0.55"},
    {"more than anyone can compute", "kind = \"fill\"\nregions = [\"inside\"]\nmass = 1e-3", "kind = \"pour\"\nregion = \"inside\"\nrate = 1\nmass = @1e7", "key 'stage.pour.mass': 10000000.0 makes 9.72e+13 particles in all, must be at most 4e+09"},
    {"a count beyond all", "mass = 1e-3", "count = @1e12", "key 'stage.fill.count': 1000000000000.0 is out of range, must be between 1 and 4e+09 particles"},
    {"pour without an end", "kind = \"fill\"\nregions = [\"inside\"]\nmass = 1e-3", "kind = \"pour\"\nregion = \"inside\"\nrate = 1", "key 'stage.pour.mass': is missing, give one of: mass, count"},
    {"pour without a rate", "kind = \"fill\"\nregions = [\"inside\"]", "kind = \"pour\"\nregion = \"inside\"", "key 'stage.pour.rate': is missing"},
    {"particles wider than the region", "diameter = 400e-6", "diameter = 9e-3", "key 'stage.fill.regions': region 'inside' is 0.008 m wide, too narrow for particles 'grain' of 0.009 m"},
    {"mixture that does not sum to 1", "mass = 1e-3", "mass = 1e-3\nmixture = @{grain = 0.7}", "key 'stage.fill.mixture': the mass fractions {grain = 0.7} sum to 0.7, must be 1"},
    {"mixture of unknown kinds", "mass = 1e-3", "mass = 1e-3\nmixture = @{corn = 1.0}", "key 'stage.fill.mixture': unknown particle kind 'corn', known: grain"},
    {"particles and mixture", "mass = 1e-3", "mass = 1e-3\nparticles = \"grain\"\nmixture = @{grain = 1.0}", "key 'stage.fill.mixture': {grain = 1.0} contradicts 'particles' = \"grain\""},
    {"a file that is not there", "kind = \"fill\"\nregions = [\"inside\"]\nmass = 1e-3", "kind = \"read\"\nfile = @\"none.csv\"", "key 'stage.read.file': the file \""},
    {"unknown stage", "kind = \"drain\"", "kind = @\"dry\"", "key 'stage.dry.kind': unknown value 'dry', known: fill, pour, read, settle, open, drain"},
    // field files and residence
    {"an unknown field", "interval = 1e-3", "interval = 1e-3\n[output.fields]\nwrite = @[\"age\", \"velocty\"]", "key 'output.fields.write': unknown field 'velocty', known: velocity, angular_velocity, force, coordination, wall_contacts, contact_stress, age; did you mean 'velocity'?"},
    {"a field named twice", "interval = 1e-3", "interval = 1e-3\n[output.fields]\nwrite = [\"age\", @\"age\"]", "key 'output.fields.write': 'age' is named twice"},
    {"no field", "interval = 1e-3", "interval = 1e-3\n[output.fields]\nwrite = @[]", "key 'output.fields.write': [] is empty"},
    {"an unknown key of field files", "interval = 1e-3", "interval = 1e-3\n[output.fields]\n@when = 1", "key 'output.fields.when': unknown key (value 1)"},
    {"a word for field files", "interval = 1e-3", "interval = 1e-3\nfields = @\"all\"", "key 'output.fields': \"all\" is of the wrong type, must be a table"},
    {"fields at a negative time", "interval = 1e-3", "interval = 1e-3\n[output.fields]\ntimes = [0.1, @-0.1]", "key 'output.fields.times': -0.1 is out of range"},
    {"more frames than a disk holds", "discharged_fraction = 0.5", "max_time = 10\n[output.fields]\ninterval = @1e-6", "key 'output.fields.interval': 1e-06 s makes 1.01e+07 frames in the stages' 10.1 s, must be at most 100000"},
    {"solid that is no flag", "interval = 1e-3", "interval = 1e-3\n[output.fields]\nsolid = @\"yes\"", "key 'output.fields.solid': \"yes\" is of the wrong type, must be true or false"},
    {"residence without an interval", "interval = 1e-3", "interval = 1e-3\n[output.residence]\ninterval = @0", "key 'output.residence.interval': 0 is out of range, must be greater than 0 and at most 1e+06 s"},
    {"residence upwards", "interval = 1e-3", "interval = 1e-3\n[output.residence]\nexit = @30e-3", "key 'output.residence.exit': 0.03 is not below entry = 0.02, m: grains go down"},
    {"residence switched off and asked for", "interval = 1e-3", "interval = 1e-3\n[output.residence]\nenabled = false\nbin = @0.1", "key 'output.residence.bin': 0.1 has no effect with enabled = false"},
    {"a negative bin", "interval = 1e-3", "interval = 1e-3\n[output.residence]\nbin = @-1", "key 'output.residence.bin': -1 is out of range, must be between 0 and 1e+06 s (0: chosen to fit)"},
    {"an unknown key of residence", "interval = 1e-3", "interval = 1e-3\n[output.residence]\n@top = 1", "key 'output.residence.top': unknown key"},
    {"residence without a layer", "[lattice]\nmaterial = \"steel\"\ncell_size = 10e-3\ncells = [1, 1, 2]\norigin = [-5e-3, -5e-3, 0]\nfibre_diameter = 1.0e-3\n", "@[output.residence]\nentry = 20e-3\n", "key 'output.residence.exit': is missing"},
};
// clang-format on

void PrintTo(const Wrong& row, std::ostream* out) { *out << row.what; }

std::string edited(const Wrong& row) {
  std::string text = testing::kGoodCase;
  if (!*row.find) return text + row.edit;
  const size_t at = text.find(row.find);
  EXPECT_NE(at, std::string::npos) << "the good case does not hold: " << row.find;
  EXPECT_EQ(text.find(row.find, at + 1), std::string::npos) << "the good case holds twice: " << row.find;
  return text.replace(at, std::string(row.find).size(), row.edit);
}

// Takes '@' out of the text; returns ":line:column: " of where it was, or ":" if there is none.
std::string take_mark(std::string& text) {
  const size_t at = text.find('@');
  if (at == std::string::npos) return ":";
  text.erase(at, 1);
  const std::string before = text.substr(0, at);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const size_t newline = before.rfind('\n');
  const size_t column = newline == std::string::npos ? at + 1 : at - newline;
  return ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

class WrongCase : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongCase, SaysWhatIsWrongAndWhere) {
  const Wrong& row = GetParam();
  testing::Folder folder;
  std::string text = edited(row);
  const std::string place = take_mark(text);
  const std::string path = folder.write("case.toml", text);
  try {
    read_case(path);
    FAIL() << "was read: " << row.what;
  } catch (const CaseError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(path + place), 0u) << "expected at " << place << ", got " << message;
    EXPECT_NE(message.find(row.expected), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Table, WrongCase, ::testing::ValuesIn(kWrong), [](const auto& info) {
  std::string name = info.param.what;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

}  // namespace
}  // namespace scree
