// A run that goes wrong stops and says where: each watch fires on a state made to be bad, none on a sound one.
#include "runtime/watch.h"

#include "tests/runtime/watch.h"

namespace scree {
namespace {

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

// A checkpoint between two looks: who goes on from it would have nothing to hold the energy against.
TEST(Watch, a_state_that_is_kept_is_looked_at_first) {
  const Case c = ceramic_case(kBox);
  Watch watch(c);
  watch.look(*two_grains(c, 1e-7, 0, 1));
  EXPECT_NO_THROW(watch.look(*two_grains(c, 1e-7, 0.01, 2))) << "it is not yet time";
  EXPECT_THROW(watch.look(*two_grains(c, 1e-7, 0.01, 2), true), RunError);
}

// However many states are kept in between: energy that doubles from one to the next is 500 steps' all the same.
TEST(Watch, looks_at_kept_states_do_not_widen_the_budget) {
  const Case c = ceramic_case(kBox);
  Watch watch(c);
  watch.look(*two_grains(c, 1e-7, 0.01, 1));
  EXPECT_NO_THROW(watch.look(*two_grains(c, 1e-7, 0.0135, 51), true)) << "less than twice the energy";
  EXPECT_THROW(watch.look(*two_grains(c, 1e-7, 0.018, 101), true), RunError) << "more than three times";
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
        EXPECT_TRUE(watch.look(*engine, true).empty());
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
