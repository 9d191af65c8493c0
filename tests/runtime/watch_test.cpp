// A run that goes wrong stops and says where: each watch fires on a state made to be bad, none on a sound one.
#include "runtime/watch.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "kernels/array.h"
#include "runtime/list_check.h"
#include "runtime/results.h"
#include "tests/oracle/beds.h"
#include "tests/runtime/case_text.h"

namespace scree {
namespace {

const Bounds kBox{{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}};

Case case_with_floor() {
  Case c = ceramic_case(kBox);
  c.gravity = {0, 0, -9.81};
  c.solid.walls = {"floor", "fibre"};
  c.solid.primitives = plane({0, 0, 0}, {0, 0, 1}, kBox, {1, 0});
  const Segment axis{{-0.005, 0, -0.005}, {0.005, 0, -0.005}};
  const Primitives fibre = fibre_network(std::span(&axis, 1), 1e-3, {1, 1});
  c.solid.primitives.insert(c.solid.primitives.end(), fibre.begin(), fibre.end());
  return c;
}

// Steps until it stops; what it said, and where.
RunError stopped(Engine& engine, int steps) {
  try {
    for (int k = 0; k < steps; ++k) engine.step();
  } catch (const RunError& error) {
    return error;
  }
  return RunError("did not stop");
}

void expect_parts(const RunError& error, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
}

void expect_near(const RunError& error, const Vec3& x, double reach) {
  ASSERT_TRUE(error.where.has_value()) << error.what();
  EXPECT_LT(norm(*error.where - x), reach) << error.what();
}

TEST(Watch, a_particle_going_through_a_wall) {
  const auto engine = make_engine(case_with_floor());
  const Vec3 at{0.001, 0.002, 0.3 * kRadius};
  engine->insert(std::vector{grain({0, 0, 0.005}), grain(at)});
  const RunError error = stopped(*engine, 1);
  expect_parts(error,
               {"particle 1 ", "(0.001, 0.002, 6e-05) m", "going through 'floor'", "t = 0 s", "from the surface"});
  expect_near(error, at, 1e-9);
}

TEST(Watch, a_particle_inside_a_fibre) {
  const auto engine = make_engine(case_with_floor());
  const Vec3 at{0.001, 1e-4, -0.005};
  engine->insert(std::vector{grain(at)});
  const RunError error = stopped(*engine, 1);
  expect_parts(error, {"particle 0 ", "going through 'fibre'", "inside the surface"});
  expect_near(error, at, 1e-9);
}

TEST(Watch, two_particles_that_overlap_too_much) {
  const auto engine = make_engine(ceramic_case(kBox));
  engine->insert(std::vector{grain({0, 0, 0}), grain({0.002, 0, 0}), grain({0.002 + 0.8 * kRadius, 0, 0})});
  const RunError error = stopped(*engine, 1);
  expect_parts(error, {"overlaps particle", "by 0.6 of the sum of the radii", "(limit 0.5)", "smaller [time] step"});
  expect_near(error, {0.002, 0, 0}, kRadius);
}

TEST(Watch, a_particle_that_is_too_fast) {
  const auto engine = make_engine(ceramic_case(kBox));
  const Vec3 at{0.001, 0, 0};
  engine->insert(std::vector{grain({0, 0, 0}), grain(at, kRadius, {0, 30, 0})});
  const RunError error = stopped(*engine, 1);
  expect_parts(error, {"particle 1 ", "moves at 30 m/s", "radii in a step"});
  expect_near(error, at, 1e-9);
}

// ---- a missed rebuild

// Two particles that touch each other, one that touches a floor, and lists made by hand.
struct Lists {
  Array<Particle<float>> particles;
  std::vector<ChunkContacts<float>> contacts{1};
  std::unique_ptr<SolidIndex> index;
  SolidTables<float> tables;
  std::vector<PreparedPrimitive> prepared_primitives;
  double max_radius = kRadius;
  uint32_t brute_force_up_to = kBruteForceUpTo;
  double period[3] = {0, 0, 0};
  double inverse_period[3] = {0, 0, 0};

  Lists() {
    contacts[0].clear(0, 3, 3);
    particles.allocate(6);
    const Vec3 x[] = {{0, 0, 0.9 * kRadius}, {0.002, 0, 0.005}, {0.002, 0, 0.005 + 1.9 * kRadius}};
    for (uint32_t k = 0; k < 6; ++k) {
      Particle<float> p{};
      p.radius = k < 3 ? float(kRadius) : -1, p.inverse_mass = 1, p.tag = k;
      if (k < 3) p.x = x[k].x, p.y = x[k].y, p.z = x[k].z;
      particles[k] = p;
    }
    const Case c = case_with_floor();
    tables = make_solid_tables<float>({c.solid, {0, 1}}, 1);
    index = make_embree_index(c.solid);
    for (const Primitive& p : c.solid.primitives) prepared_primitives.push_back(prepared(p));
  }
  void list_pair() { contacts[0].append(1, 2); }
  void list_floor() {
    SolidBlock block{};
    block.i[5] = 0, block.quads = 1;
    contacts[0].solid_blocks.push_back(block);
    SolidSlot<float>& slot = contacts[0].slots.emplace_back();
    for (uint32_t& row : slot.primitive) row = tables.quads.dummy();
    slot.primitive[5] = 0;
  }
  std::optional<MissingContact> check() const {
    return find_missing_contact<float>({particles.data(), 3, 256, &contacts, kBox, period, inverse_period, max_radius,
                                        index.get(), &tables, &prepared_primitives, brute_force_up_to});
  }
};

TEST(Watch, complete_lists_are_complete) {
  Lists lists;
  lists.list_pair(), lists.list_floor();
  EXPECT_FALSE(lists.check());
}

TEST(Watch, a_pair_missing_from_the_lists) {
  Lists lists;
  lists.list_floor();
  lists.contacts[0].near.push_back({1, 2});  // waiting is not enough for a pair that touches
  const auto missing = lists.check();
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->i, 1u);
  EXPECT_EQ(missing->j, 2u);
  EXPECT_NEAR(missing->overlap, 0.1 * kRadius, 1e-9);
}

TEST(Watch, a_wall_missing_from_the_lists) {
  Lists lists;
  lists.list_pair();
  const auto missing = lists.check();
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->i, 0u);
  EXPECT_FALSE(missing->j);
  EXPECT_EQ(missing->kind, 1);
}

TEST(Watch, a_pair_across_a_periodic_border_counts) {
  Lists lists;
  lists.list_floor(), lists.list_pair();
  lists.period[0] = 0.02;
  lists.inverse_period[0] = 50;
  lists.particles[0].x = kBox.max.x - 0.5 * kRadius;
  lists.particles[1].x = kBox.min.x + 0.4 * kRadius, lists.particles[1].z = lists.particles[0].z;
  lists.particles[2].z = 0.006;
  const auto missing = lists.check();
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->i, 0u);
  EXPECT_EQ(missing->j, 1u);
}

// A fault of the search itself, which the check by cells and index shares: cells too narrow for the particles, an index
// that does not know the floor. Brute force has no part in either.
TEST(Watch, brute_force_sees_what_a_faulty_grid_does_not) {
  Lists lists;
  lists.list_floor();
  lists.particles[2].x = 0.002 + 1.9 * kRadius, lists.particles[2].z = lists.particles[1].z;
  lists.max_radius = 1e-2 * kRadius;  // cells of a fiftieth of a diameter
  lists.brute_force_up_to = 0;
  EXPECT_FALSE(lists.check()) << "the fault is not one";
  lists.brute_force_up_to = 2;  // three particles are more
  EXPECT_FALSE(lists.check());
  lists.brute_force_up_to = 3;
  const auto missing = lists.check();
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->i, 1u);
  EXPECT_EQ(missing->j, 2u);
}

TEST(Watch, brute_force_sees_what_a_faulty_index_does_not) {
  Lists lists;
  lists.list_pair();
  Case without_floor = case_with_floor();
  std::erase_if(without_floor.solid.primitives, [](const Primitive& p) { return p.wall == 0; });
  lists.index = make_embree_index(without_floor.solid);
  lists.brute_force_up_to = 0;
  EXPECT_FALSE(lists.check()) << "the fault is not one";
  lists.brute_force_up_to = kBruteForceUpTo;
  const auto missing = lists.check();
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->i, 0u);
  EXPECT_FALSE(missing->j);
}

// ---- energy and time step

EnergyLook look(double time, double kinetic) { return {time, kinetic, 1e-4, 0.1, 1e-3, 1000, 1000}; }

TEST(Watch, energy_from_gravity_is_in_the_budget_and_an_explosion_is_not) {
  const EnergyBudget budget(case_with_floor());
  const double falling = 1e-4 * 9.81 * 0.1 * 1e-3;  // all of it at 0.1 m/s for 1 ms
  EXPECT_GT(budget.most_after(look(0, 1e-6), look(1e-3, 0)), 1e-6 + falling);
  EXPECT_LT(budget.most_after(look(0, 1e-6), look(1e-3, 0)), 1e-4);
}

TEST(Watch, energy_held_by_contacts_is_in_the_budget) {
  // One grain at the turning point of its bounce: no kinetic energy, all of it elastic.
  const Case c = case_with_floor();
  const double speed = 0.5, mass = grain({0, 0, 0}).mass, modulus = 1e7 / (1 - 0.28 * 0.28);
  const double energy = 0.5 * mass * speed * speed;
  const double overlap = std::pow(energy / (8.0 / 15 * modulus * std::sqrt(kRadius)), 0.4);
  const EnergyLook before{0, 0, mass, 0, overlap / kRadius, 1, 1}, after{1e-3, energy, mass, speed, 0, 1, 1};
  EXPECT_GT(EnergyBudget(c).most_after(before, after), energy);
}

std::unique_ptr<Engine> two_grains(Case c, double time_step, double speed, int steps) {
  c.time.step = time_step;
  auto engine = make_engine(c);
  engine->insert(std::vector{grain({0.001, 0, 0}), grain({0.002, 0, 0}, kRadius, {0, speed, 0})});
  run_steps(*engine, steps);
  return engine;
}

TEST(Watch, energy_that_comes_from_nowhere_stops_the_run) {
  const Case c = ceramic_case(kBox);
  Watch watch(c);
  EXPECT_TRUE(watch.look(*two_grains(c, 1e-7, 0, 0)).empty());
  try {
    watch.look(*two_grains(c, 1e-7, 0.01, 500));  // as if it were the same run
    FAIL() << "an energy of 0 became one of 0.01 m/s";
  } catch (const RunError& error) {
    expect_parts(error, {"kinetic energy", "rose from 0 J at t = 0 s", "fastest is particle 1 at"});
    expect_near(error, {0.002, 0, 0}, 1e-6);
  }
}

TEST(Watch, a_step_too_large_for_the_speed_warns_once_and_then_stops) {
  const Case c = ceramic_case(kBox);
  const double hertz = hertz_time(c.materials[0], kRadius, 1);
  EXPECT_TRUE(Watch(c).look(*two_grains(c, 0.15 * hertz, 1, 1)).empty());
  Watch watch(c);
  EXPECT_EQ(watch.look(*two_grains(c, 0.3 * hertz, 1, 1)).size(), 1u);
  EXPECT_TRUE(watch.look(*two_grains(c, 0.3 * hertz, 1, 501)).empty());
  try {
    Watch(c).look(*two_grains(c, 0.6 * hertz, 1, 1));
    FAIL() << "a contact would last less than two steps";
  } catch (const RunError& error) {
    expect_parts(error, {"0.60 of the Hertz contact time", "of particle 1 at", "at most 0.5 is allowed"});
    expect_near(error, {0.002, 0, 0}, 1e-3);
  }
}

// ---- a sound bed: every watch on, at every step, and the bits stay

TEST(Watch, a_sound_bed_is_left_alone_to_the_bit) {
  Case c = case_with_floor();
  c.periodic[0] = c.periodic[1] = true;
  uint64_t hash[2];
  for (const bool watched : {false, true}) {
    EngineOptions options;
    options.list_check_interval = watched ? 1 : 0;
    const auto engine = make_engine(c, options);
    engine->insert(LooseBed{8, 8, 6, 1e-4, kRadius}.particles({-0.004, -0.004, 3e-4}, 1));
    Watch watch(c);
    for (int k = 0; k < 3000; ++k) {
      engine->step();
      if (watched) {
        EXPECT_TRUE(watch.look(*engine).empty());
      }
    }
    hash[watched] = engine->state_hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(Watch, the_neighbourhood_of_a_failure_is_written) {
  const testing::Folder folder;
  const std::vector<ParticleState> all{grain({0, 0, 0}), grain({0.001, 0, 0}), grain({0.005, 0, 0})};
  write_neighbourhood_vtp(folder.path("failure.vtp"), all, {0, 0, 0}, 0.002);
  std::ifstream file(folder.path("failure.vtp"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("NumberOfPoints=\"2\""), std::string::npos);
}

}  // namespace
}  // namespace scree
