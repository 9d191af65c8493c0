// The mixed-precision engine against the double reference: forces of one step on a dense bed, where a bed comes to
// rest, free fall, and a bed that is still settling. Claim: on a bed some fifteen layers deep a step's force is right
// to 1e-4 m g, and to 1e-5 m g rms. What of kinetic energy holds and what does not: bench/README.md, "Precision".
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/oracle/beds.h"

namespace scree {
namespace {

constexpr double kGravity = 9.81;  // m/s2

struct ForceError {
  double max = 0, rms = 0;  // in weights of the particle
  double deepest = 0;       // largest acceleration by contacts, in g: what the error is to be held against
};

ForceError force_error(const std::vector<Vec3>& test, const std::vector<Vec3>& reference) {
  ForceError e;
  for (size_t k = 0; k < test.size(); ++k) {
    const double error = norm(test[k] - reference[k]);
    e.max = std::max(e.max, error), e.rms += error * error / static_cast<double>(test.size());
    e.deepest = std::max(e.deepest, norm(reference[k]));
  }
  e.rms = std::sqrt(e.rms);
  return e;
}

Case with_precision(Case c, Precision precision) {
  c.contact.precision = precision;
  return c;
}

// Dropped from a loose grid and left to come to rest, by the engine itself.
std::vector<ParticleState> settled(const LooseBed& bed, int steps) {
  const auto engine = make_engine(bed_case(bed));
  engine->insert(bed.particles({0, 0, 0}, 17));
  run_steps(*engine, steps);
  return by_id(*engine);
}

struct BedAverages {
  double overlap = 0;         // m, mean over touching pairs
  double coordination = 0;    // particle-particle contacts of a particle
  double kinetic_energy = 0;  // J
};

BedAverages averages(const Engine& engine) {
  BedAverages a;
  const auto pairs = engine.touching_pairs();
  for (const auto& p : pairs) a.overlap += p.overlap / static_cast<double>(pairs.size());
  a.coordination = 2.0 * static_cast<double>(pairs.size()) / static_cast<double>(engine.count());
  a.kinetic_energy = engine.sum([](const ParticleState& p) { return 0.5 * p.mass * dot(p.velocity, p.velocity); });
  return a;
}

// Both engines from the same state, step by step side by side.
class TwoPrecisions {
 public:
  TwoPrecisions(const Case& c, const std::vector<ParticleState>& start)
      : mixed_(make_engine(with_precision(c, Precision::mixed))),
        reference_(make_engine(with_precision(c, Precision::reference))) {
    mixed_->insert(start), reference_->insert(start);
  }
  const Engine& mixed() const { return *mixed_; }
  const Engine& reference() const { return *reference_; }
  void step(int steps) { run_steps(*mixed_, steps), run_steps(*reference_, steps); }

  // One step; `kick` is the time for which its forces act.
  ForceError step_and_compare(double kick) {
    return force_error(accelerations(*mixed_, kick), accelerations(*reference_, kick));
  }

 private:
  static std::vector<Vec3> accelerations(Engine& engine, double kick) {
    const auto before = by_id(engine);
    engine.step();
    const auto after = by_id(engine);
    std::vector<Vec3> a;
    for (size_t k = 0; k < after.size(); ++k)
      a.push_back((1 / (kick * kGravity)) * (after[k].velocity - before[k].velocity));
    return a;
  }
  std::unique_ptr<Engine> mixed_, reference_;
};

void report(const std::string& name, double value) {
  ::testing::Test::RecordProperty(name, fmt::format("{:.3g}", value));
  fmt::print("{} = {:.3g}\n", name, value);
}

void expect_within_claim(const ForceError& e, const std::string& step) {
  report(step + "_force_error_max_mg", e.max);
  report(step + "_force_error_rms_mg", e.rms);
  report(step + "_largest_force_mg", e.deepest);
  EXPECT_GT(e.rms, 0);
  EXPECT_LE(e.max, 1e-4);
  EXPECT_LE(e.rms, 1e-5);
  EXPECT_GT(e.deepest, 1);
}

double difference(double value, double reference) { return std::abs(value / reference - 1); }

// `energy`: the bound on the relative difference of kinetic energies, twice what was seen. Of a bed at rest that is a
// difference of next to nothing: its grains creep at 0.1 mm/s. For one size it is within the 1e-6 that are asked for.
void expect_precisions_agree(const LooseBed& bed, int settling_steps, double energy) {
  const Case c = bed_case(bed);
  TwoPrecisions both(c, settled(bed, settling_steps));
  // The first step has normal forces and damping only and kicks by half a step; the second adds friction.
  expect_within_claim(both.step_and_compare(0.5 * kStep), "first_step");
  expect_within_claim(both.step_and_compare(kStep), "second_step");
  both.step(1998);
  const BedAverages mixed = averages(both.mixed()), reference = averages(both.reference());
  report("mean_overlap_difference", difference(mixed.overlap, reference.overlap));
  report("coordination_difference", std::abs(mixed.coordination - reference.coordination));
  report("kinetic_energy", reference.kinetic_energy);
  report("kinetic_energy_difference", difference(mixed.kinetic_energy, reference.kinetic_energy));
  report("coordination", reference.coordination);
  EXPECT_GT(reference.coordination, 3.5);
  EXPECT_LT(difference(mixed.overlap, reference.overlap), 1e-6);
  EXPECT_EQ(mixed.coordination, reference.coordination);
  EXPECT_LT(difference(mixed.kinetic_energy, reference.kinetic_energy), energy);
}

TEST(Precision, OfForcesOnADenseBedIsAsClaimed) {
  expect_precisions_agree({11, 11, 14, kRadius, kRadius, 2.6}, 25000, 1e-6);
}

TEST(Precision, OfForcesOnADenseBedOfSizesOneToThreeIsAsClaimed) {
  expect_precisions_agree({8, 8, 12, kRadius, 3 * kRadius, 2.6}, 40000, 5e-6);
}

// A velocity is a float and g dt is a small part of it: the sum is rounded, and as g dt is the same in each step, it is
// rounded the same way until the velocity's exponent changes. The error does not average out.
TEST(Precision, OfVelocitiesInFreeFall) {
  Case c = ceramic_case({{-1, -1, -1}, {1, 1, 1}});
  c.gravity = {0, 0, -kGravity};
  std::vector<ParticleState> start;
  for (int k = 0; k < 200; ++k) start.push_back(grain({4e-3 * k - 0.4, 0, 0.5}, kRadius, {0, 0, -1e-3 * k}));
  TwoPrecisions both(c, start);
  both.step(2000);
  const auto mixed = by_id(both.mixed()), reference = by_id(both.reference());
  double worst = 0;
  for (size_t k = 0; k < mixed.size(); ++k)
    worst = std::max(worst, difference(mixed[k].velocity.z, reference[k].velocity.z));
  report("free_fall_velocity_error_max", worst);
  EXPECT_GT(worst, 1e-6);
  EXPECT_LT(worst, 8.5e-5);
}

// A bed in the middle of its settling: two runs in double of which one started from velocities that were rounded as a
// float is come out percents apart, so of the mixed run's difference after as many steps nothing can be asked: it is
// reported beside theirs.
TEST(Precision, OfABedThatSettlesIsThatOfItsStart) {
  const LooseBed bed{11, 11, 14, kRadius, kRadius, 2.6};
  const Case c = with_precision(bed_case(bed), Precision::reference);
  const std::vector<ParticleState> start = settled(bed, 4000);
  TwoPrecisions both(c, start);
  both.step(200);
  const double early = difference(averages(both.mixed()).kinetic_energy, averages(both.reference()).kinetic_energy);
  both.step(1800);
  const BedAverages reference = averages(both.reference());
  const double late = difference(averages(both.mixed()).kinetic_energy, reference.kinetic_energy);
  double rounded = 0;  // the largest difference that a rounded start makes
  for (uint32_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    std::vector<ParticleState> other = start;
    for (ParticleState& p : other) p.velocity = (1 + random.between(-6e-8, 6e-8)) * p.velocity;
    const auto engine = make_engine(c);
    engine->insert(other);
    run_steps(*engine, 2000);
    rounded = std::max(rounded, difference(averages(*engine).kinetic_energy, reference.kinetic_energy));
  }
  report("settling_kinetic_energy", reference.kinetic_energy);
  report("settling_energy_difference_200_steps", early);
  report("settling_energy_difference_2000_steps", late);
  report("settling_energy_difference_of_a_rounded_start", rounded);
  EXPECT_LT(early, 1e-5);
  EXPECT_GT(rounded, 1e-4);
}

}  // namespace
}  // namespace scree
