// A run that goes wrong stops and says where: each watch fires on a state made to be bad, none on a sound one.
#include "runtime/watch.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "kernels/array.h"
#include "runtime/list_check.h"
#include "runtime/results.h"
#include "runtime/state_archive.h"
#include "tests/array_memory.h"
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

// What `engine` saves, in a fresh engine of the same case; `edit` changes it on the way.
std::unique_ptr<Engine> saved_and_loaded(const Engine& engine, const Case& c, const EngineOptions& options = {},
                                         const std::function<void(StoredArrays&)>& edit = {}) {
  const testing::Folder folder;
  const std::string path = folder.path("state.h5");
  {
    Hdf5Writer file(path);
    StateWriter out(file);
    engine.save(out);
    file.close();
  }
  RecordingSource source(path);
  StateReader recorded(source);
  auto loaded = make_engine(c, options);
  loaded->load(recorded);
  if (!edit) return loaded;
  edit(source.arrays);
  MemorySource memory(source.arrays);
  StateReader edited(memory);
  loaded = make_engine(c, options);
  loaded->load(edited);
  return loaded;
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

TEST(Watch, two_particles_that_overlap_more_than_the_case_allows) {
  Case c = ceramic_case(kBox);
  const std::vector<ParticleState> pair{grain({0, 0, 0}), grain({1.8 * kRadius, 0, 0})};
  const auto usual = make_engine(c);
  usual->insert(pair);
  EXPECT_NO_THROW(run_steps(*usual, 1));
  c.watch.max_overlap = 0.05;
  const auto strict = make_engine(c);
  strict->insert(pair);
  expect_parts(stopped(*strict, 1), {"overlaps particle", "by 0.1 of the sum of the radii", "(limit 0.05)"});
}

TEST(Watch, a_particle_that_is_too_fast) {
  const auto engine = make_engine(ceramic_case(kBox));
  const Vec3 at{0.001, 0, 0};
  engine->insert(std::vector{grain({0, 0, 0}), grain(at, kRadius, {0, 30, 0})});
  const RunError error = stopped(*engine, 1);
  expect_parts(error, {"particle 1 ", "moves at 30 m/s", "radii in a step"});
  expect_near(error, at, 1e-9);
}

// Of a speed that only single precision finds beyond the limit the particle is named, too.
TEST(Watch, a_particle_that_is_too_fast_by_rounding) {
  const Case c = ceramic_case(kBox);
  const double limit = kMaxTravelShare * grain({}).radius / kStep;
  std::optional<Vec3> velocity;
  for (int k = 0; k < 100000 && !velocity; ++k) {
    const auto x = static_cast<float>(limit * std::cos(1e-5 * k)), y = static_cast<float>(limit * std::sin(1e-5 * k));
    const Vec<float> v{x, y, 0};
    if (norm({x, y, 0}) <= limit && dot(v, v) > static_cast<float>(limit * limit)) velocity = {x, y, 0};
  }
  ASSERT_TRUE(velocity);
  const auto engine = make_engine(c);
  engine->insert(std::vector{grain({0, 0, 0}), grain({0.001, 0, 0}, kRadius, *velocity)});
  expect_parts(stopped(*engine, 1), {"particle 1 at (0.0010", "radii in a step"});
}

TEST(Watch, a_position_that_is_not_a_number) {
  const auto engine = make_engine(ceramic_case(kBox));
  engine->insert(std::vector{grain({0, 0, 0}), grain({0, std::nan(""), 0})});
  expect_parts(stopped(*engine, 1), {"particle 1 left the domain at (0, nan, 0) m, t = 0 s"});
}

TEST(Watch, a_velocity_that_is_not_a_number) {
  const auto engine = make_engine(ceramic_case(kBox));
  const Vec3 at{0.001, 0, 0};
  engine->insert(std::vector{grain({0, 0, 0}), grain(at, kRadius, {0, std::nan(""), 0})});
  const RunError error = stopped(*engine, 1);
  expect_parts(error, {"the velocity of particle 1, which was at (0.001, 0, 0) m, is not a number at t = 5e-06 s",
                       "use a smaller [time] step (now 5e-06 s)"});
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

// The engine's own look, on lists that were made when the second particle was elsewhere.
TEST(Watch, a_contact_that_the_engines_lists_do_not_hold) {
  const Case c = ceramic_case(kBox);
  EngineOptions options;
  options.list_check_interval = 1;
  const auto sound = make_engine(c, options);
  const Vec3 at{0.001, 0, 0};
  sound->insert(std::vector{grain(at), grain({0.008, 0, 0})});
  run_steps(*sound, 3);
  const auto moved = saved_and_loaded(*sound, c, options, [&](StoredArrays& arrays) {
    std::vector<char>& bytes = arrays.at("engine/particles").bytes;
    std::vector<Particle<float>> records(2);
    std::memcpy(static_cast<void*>(records.data()), bytes.data(), bytes.size());
    for (Particle<float>& p : records)
      if (p.id() == 1) p.x = at.x + 1.9 * kRadius;
    std::memcpy(bytes.data(), records.data(), bytes.size());
  });
  const RunError error = stopped(*moved, 1);
  expect_parts(error, {"touches particle", "at t = 2e-05 s", "the contact lists do not hold it", "please report"});
  expect_near(error, at, 2 * kRadius);
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

EnergyLook look(double time, double kinetic) { return {time, kinetic, 1e-4, 0.0, 0.1, 1000, 1000}; }

// All of it falls together: as much as gravity can give. Five times as much is not gravity's.
TEST(Watch, energy_from_gravity_is_in_the_budget_and_no_more_is) {
  const EnergyBudget budget(case_with_floor());
  const double mass = 1e-4, speed = 0.1, time = 2.5e-3, faster = speed + 9.81 * time;
  const auto kinetic = [&](double v) { return 0.5 * mass * v * v; };
  const double most = budget.most_after(look(0, kinetic(speed)), look(time, 0));
  EXPECT_GT(most, kinetic(faster));
  EXPECT_LT(most, 5 * kinetic(faster));
}

TEST(Watch, energy_held_by_contacts_is_in_the_budget) {
  // One grain at the turning point of its bounce: no kinetic energy, all of it elastic.
  const Case c = case_with_floor();
  const double speed = 0.5, mass = grain({0, 0, 0}).mass, energy = 0.5 * mass * speed * speed;
  const EnergyLook before{0, 0, mass, energy, 0, 1, 1}, after{1e-3, energy, mass, energy, speed, 1, 1};
  EXPECT_GT(EnergyBudget(c).most_after(before, after), energy);
}

TEST(Watch, energy_that_comes_in_with_particles_is_in_the_budget) {
  Case c = case_with_floor();
  PourStage pour;
  FillStage fill;
  pour.velocity = {0, 0, -3}, fill.velocity = {0, 4, 0};
  c.stages = {{"fill", fill}};
  EnergyLook after = look(1e-3, 0);
  after.inserted += 10;
  const EnergyBudget budget(c);
  ASSERT_TRUE(budget.compares(look(0, 0), after));
  const double came = 10 * 0.5 * grain({0, 0, 0}).mass, none = budget.most_after(look(0, 0), look(1e-3, 0));
  EXPECT_GT(budget.most_after(look(0, 0), after), none + 16 * came);
  c.stages = {{"pour", pour}};
  EXPECT_GT(EnergyBudget(c).most_after(look(0, 0), after), none + 9 * came);
  c.stages = {{"read", ReadStage{}}};
  EXPECT_FALSE(EnergyBudget(c).compares(look(0, 0), after));  // a file may say anything
}

// A bed at rest whose grains all start upwards at 0.15 m/s: less than any of them may move on its own.
TEST(Watch, a_bed_at_rest_that_starts_to_move_stops_the_run) {
  const LooseBed bed{8, 8, 6};
  const Case c = bed_case(bed);
  const auto engine = make_engine(c);
  engine->insert(bed.particles({0, 0, 0}, 1));
  run_steps(*engine, 12000);
  Watch watch(c);
  watch.look(*engine);
  run_steps(*engine, 500);
  EXPECT_NO_THROW(watch.look(*engine));
  EXPECT_EQ(watch.energy_looks(), 1u);
  EXPECT_LT(watch.largest_energy_share(), 1);
  EXPECT_GT(watch.largest_energy_share(), 0);
  run_steps(*engine, 500);
  const auto moved = saved_and_loaded(*engine, c, {}, [&](StoredArrays& arrays) {
    std::vector<char>& bytes = arrays.at("engine/particles").bytes;
    std::vector<Particle<float>> records(bytes.size() / sizeof(Particle<float>));
    std::memcpy(static_cast<void*>(records.data()), bytes.data(), bytes.size());
    for (Particle<float>& p : records) p.vz += 0.15F;
    std::memcpy(bytes.data(), records.data(), bytes.size());
  });
  try {
    watch.look(*moved);
    FAIL() << "a bed rose by itself";
  } catch (const RunError& error) {
    expect_parts(error, {"kinetic energy of all particles rose from", "use a smaller [time] step"});
  }
}

// All energy is in the contact there, none in motion: who resumes must know of the overlap before a step is taken.
TEST(Watch, a_run_resumed_at_the_turning_point_of_a_bounce_goes_on) {
  Case c = case_with_floor();
  c.gravity = {0, 0, 0}, c.time.step = 1e-6;
  auto engine = make_engine(c);
  engine->insert(std::vector{grain({0, 0, 1.1 * kRadius}, kRadius, {0, 0, -0.5})});
  double least = 1;
  for (double speed = 0.5; speed <= least; speed = engine->max_speed()) least = speed, engine->step();
  ASSERT_LT(least, 0.03);
  ASSERT_GT(engine->max_overlap(), 0.03);
  const double overlap = engine->max_overlap();
  engine = saved_and_loaded(*engine, c);
  EXPECT_EQ(engine->max_overlap(), overlap);
  Watch watch(c);
  EXPECT_TRUE(watch.look(*engine).empty());
  run_steps(*engine, 500);
  EXPECT_GT(engine->max_speed(), 0.15);
  EXPECT_NO_THROW(watch.look(*engine));
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
  EXPECT_TRUE(watch.look(*two_grains(c, 1e-7, 0, 1)).empty());
  try {
    watch.look(*two_grains(c, 1e-7, 0.01, 501));  // as if it were the same run
    FAIL() << "an energy of 0 became one of 0.01 m/s";
  } catch (const RunError& error) {
    expect_parts(error, {"kinetic energy", "rose from 0 J at t = ", "fastest is particle 1 at"});
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

TEST(Watch, a_lost_particle_stops_the_run_at_the_next_look) {
  const Case c = ceramic_case(kBox);
  const auto whole = two_grains(c, kStep, 0, 1);
  EXPECT_TRUE(Watch(c).look(*whole).empty());
  const auto lost = saved_and_loaded(*whole, c, {}, [](StoredArrays& arrays) {
    const uint64_t inserted = 3;
    std::memcpy(arrays.at("engine/counters/inserted").bytes.data(), &inserted, sizeof inserted);
  });
  try {
    Watch(c).look(*lost);
    FAIL() << "of three particles two are left, and none went out";
  } catch (const RunError& error) {
    expect_parts(error, {"3 particles went in, 0 left through outlets, 2 are left at t = 5e-06 s: 1 lost"});
  }
}

TEST(Watch, a_spin_too_large_for_the_step_warns_once_and_one_that_is_no_number_stops) {
  const Case c = ceramic_case(kBox);
  const auto spinning = [&](double spin) {
    auto engine = make_engine(c);
    ParticleState p = grain({0.002, 0, 0});
    p.spin = {0, spin, 0};
    engine->insert(std::vector{grain({0.001, 0, 0}), p});
    run_steps(*engine, 1);
    return engine;
  };
  const double limit = kMaxTravelShare / kStep;  // rad/s
  EXPECT_TRUE(Watch(c).look(*spinning(0.99 * limit)).empty());
  Watch watch(c);
  const auto engine = spinning(1.5 * limit);
  const std::vector<std::string> warnings = watch.look(*engine);
  ASSERT_EQ(warnings.size(), 1u);
  for (const char* part :
       {"the surface of particle 1 at (0.002, 0, 0) m spins at 12 m/s", "t = 5e-06 s", "[time] step"})
    EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
  run_steps(*engine, 500);
  EXPECT_TRUE(watch.look(*engine).empty());
  try {
    Watch(c).look(*spinning(std::nan("")));
    FAIL() << "a spin is not a number";
  } catch (const RunError& error) {
    expect_parts(error, {"the spin of particle 1 at (0.002, 0, 0) m is not a number", "t = 5e-06 s"});
    expect_near(error, {0.002, 0, 0}, 1e-9);
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
  const auto engine = make_engine(ceramic_case(kBox));
  engine->insert(std::vector{grain({0, 0, 0}), grain({0.001, 0, 0}), grain({0.005, 0, 0})});
  write_neighbourhood_vtp(folder.path("failure.vtp"), *engine, {0, 0, 0}, 0.002);
  std::ifstream file(folder.path("failure.vtp"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("NumberOfPoints=\"2\""), std::string::npos);
}

}  // namespace
}  // namespace scree
