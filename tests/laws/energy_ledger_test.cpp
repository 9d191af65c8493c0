// The ledger of a run against what is known of it otherwise.
#include "runtime/energy_balance.h"

#include "kernels/step_kernels.h"
#include "tests/laws/law_test.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

class EnergyLedgerOf : public LawTest {
 protected:
  Case with_ledger(Case c) {
    c.contact.precision = GetParam();
    c.output.energy_ledger = true;
    return c;
  }
  // Of residuals, in shares of what was turned over.
  double closing() const { return GetParam() == Precision::reference ? 1e-9 : kLedgerTolerance; }
};

constexpr double kAWaysShare = 1e-2;  // of gravity's work, that a way of one step may be

void expect_closed(const EnergyBalance& b, double tolerance) {
  EXPECT_GT(b.turned_over, 0);
  EXPECT_LT(b.energy_residual_share(), tolerance);
  EXPECT_LT(b.momentum_residual_share(), tolerance);
}

TEST_P(EnergyLedgerOf, a_bed_that_falls_and_settles_closes) {
  const LooseBed bed{8, 8, 6};
  const Case c = with_ledger(bed_case(bed));
  const auto engine = make_engine(c);
  engine->insert(bed.particles({0, 0, 0}, 1));
  run_steps(*engine, 4000);
  const EnergyBalance b = balance_of(*engine, c);
  expect_closed(b, closing());
  EXPECT_GT(b.damping, 0);
  EXPECT_GT(b.friction, 0);
  EXPECT_GT(b.rolling, 0);
  // What was turned over is dissipated: nearly nothing is left in motion.
  EXPECT_LT(b.kinetic + b.elastic, 0.2 * b.turned_over);
  EXPECT_LT(b.time_stepping_share(), 0.1);
  EXPECT_NEAR(*b.potential, -b.gravity, kAWaysShare * b.turned_over);
}

TEST_P(EnergyLedgerOf, a_head_on_impact_loses_what_restitution_says_to_the_dashpot) {
  Case c = with_ledger(ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}}));
  c.time.step = 2e-7;
  const auto engine = make_engine(c);
  const double speed = 0.3;
  engine->insert(
      std::vector{grain({-2.5e-4, 0, 0}, kRadius, {speed, 0, 0}), grain({2.5e-4, 0, 0}, kRadius, {-speed, 0, 0})});
  run_steps(*engine, 3000);
  ASSERT_TRUE(engine->contacts().empty());
  const EnergyBalance b = balance_of(*engine, c);
  const double e = c.pairs[0].restitution;
  EXPECT_NEAR(b.damping, (1 - e * e) * b.inserted_kinetic, 0.01 * b.inserted_kinetic);
  EXPECT_NEAR(b.friction, 0, 1e-6 * b.inserted_kinetic);
  EXPECT_NEAR(b.time_stepping, 0, 0.02 * b.inserted_kinetic);
  expect_closed(b, closing());
}

// What finite steps make of a damped impact goes with the step, and all of it is in that term.
TEST_P(EnergyLedgerOf, what_finite_steps_make_halves_with_the_step) {
  const auto made_by = [&](double step) {
    Case c = with_ledger(ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}}));
    c.time.step = step, c.pairs[0].restitution = 0.3;
    const auto engine = make_engine(c);
    engine->insert(
        std::vector{grain({-2.1e-4, 0, 0}, kRadius, {0.3, 0, 0}), grain({2.1e-4, 0, 0}, kRadius, {-0.3, 0, 0})});
    run_steps(*engine, static_cast<int>(4e-4 / step));
    const EnergyBalance b = balance_of(*engine, c);
    EXPECT_TRUE(b.closes());
    return b.time_stepping_share();
  };
  const double coarse = made_by(2e-6), fine = made_by(1e-6);
  EXPECT_GT(coarse, 0.005);
  EXPECT_NEAR(coarse / fine, 2, 0.2);
}

TEST_P(EnergyLedgerOf, a_moving_wall_pays_for_the_motion_that_it_gives) {
  Case c = with_ledger(ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}}));
  c.solid.walls = {"belt"};
  c.solid.primitives = rectangle({-0.01, -0.01, 0}, {0.02, 0, 0}, {0, 0.02, 0}, {1, 0});
  for (Primitive& p : c.solid.primitives) p.velocity = {0.1, 0, 0};
  c.gravity = {0, 0, -9.81};
  const auto engine = make_engine(c);
  engine->insert(std::vector{grain({0, 0, 0.99 * kRadius})});
  run_steps(*engine, 2000);
  const EnergyBalance b = balance_of(*engine, c);
  EXPECT_GT(b.walls, 0);
  expect_closed(b, closing());
  // All motion along x comes from the belt: impulse times its speed.
  EXPECT_NEAR(b.walls, 0.1 * engine->counters().ledger.steps.solid_impulse[0], 1e-6 * b.walls);
}

TEST_P(EnergyLedgerOf, particles_that_leave_take_their_energy_with_them) {
  Case c = with_ledger(ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}}));
  c.gravity = {0, 0, -9.81};
  const auto engine = make_engine(c);
  engine->set_removal([](const ParticleState& p) { return p.position.z < -0.002 ? 0 : -1; });
  engine->insert(std::vector{grain({0, 0, 0}), grain({0.002, 0, 0.001}, kRadius, {0, 0, 0.2})});
  while (engine->count() > 0 && engine->counters().steps < 40000) engine->step();
  ASSERT_EQ(engine->count(), 0u);
  const EnergyBalance b = balance_of(*engine, c);
  EXPECT_EQ(b.kinetic, 0);
  EXPECT_NEAR(b.removed_kinetic, b.inserted_kinetic + b.gravity, closing() * b.turned_over);
  EXPECT_NEAR(*b.potential, -b.gravity, kAWaysShare * b.turned_over);
  expect_closed(b, closing());
}

TEST_P(EnergyLedgerOf, keeping_it_does_not_change_the_run) {
  const LooseBed bed{6, 6, 4};
  Case c = bed_case(bed);
  c.contact.precision = GetParam();
  const auto without = make_engine(c), with = make_engine(with_ledger(c));
  for (Engine* engine : {without.get(), with.get()}) {
    engine->insert(bed.particles({0, 0, 0}, 3));
    run_steps(*engine, 1500);
  }
  EXPECT_EQ(without->state_hash(), with->state_hash());
}

TEST(EnergyLedger, has_no_potential_where_gravity_pulls_round_a_periodic_axis) {
  Case c = ceramic_case({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}}, {'x'});
  c.output.energy_ledger = true;
  c.gravity = {1, 0, -9.81};
  const auto engine = make_engine(c);
  engine->insert(std::vector{grain({0, 0, 0})});
  run_steps(*engine, 10);
  EXPECT_FALSE(balance_of(*engine, c).potential);
  EXPECT_TRUE(to_json(balance_of(*engine, c))["potential_J"].is_null());
  c.gravity.x = 0;
  EXPECT_TRUE(to_json(balance_of(*engine, c))["potential_J"].is_number());
}

TEST(EnergyLedger, that_does_not_close_is_complained_of) {
  EnergyBalance b;
  b.turned_over = b.impulse_turned_over = 1, b.energy_residual = 0.9 * kLedgerTolerance;
  EXPECT_EQ(complaint(b), "");
  b.energy_residual = -0.02;
  EXPECT_NE(complaint(b).find("does not close: 0.02 of the energy and 0 of the momentum"), std::string::npos);
  b.energy_residual = 0, b.momentum_residual = {0, 0, 0.5};
  EXPECT_NE(complaint(b).find("0.5 of the momentum"), std::string::npos);
  b.momentum_residual = {0, 0, std::nan("")};
  EXPECT_NE(complaint(b), "");
  b.momentum_residual = {}, b.time_stepping = 0.5;
  EXPECT_NE(complaint(b).find("0.5 of the energy come of finite steps"), std::string::npos);
  b.overlaps_unbooked = true;
  EXPECT_EQ(complaint(b), "");
  b = {};
  EXPECT_TRUE(b.closes());  // nothing happened
  b.turned_over = b.energy_residual = std::nan("");
  EXPECT_FALSE(b.closes());
  b.turned_over = 0, b.energy_residual = 1;
  EXPECT_FALSE(b.closes());
}

TEST(EnergyLedger, is_the_same_for_any_threads_and_lanes) {
  const LooseBed bed{20, 20, 6};
  Case c = bed_case(bed);
  c.output.energy_ledger = true;
  std::vector<double> frictions;
  for (const std::string& isa : available_isas())
    for (const int threads : {1, 3}) {
      set_thread_count(threads);
      EngineOptions options;
      options.isa = isa;
      const auto engine = make_engine(c, options);
      engine->insert(bed.particles({0, 0, 0}, 5));
      run_steps(*engine, 1200);
      frictions.push_back(engine->counters().ledger.steps.friction);
    }
  EXPECT_GT(frictions[0], 0);
  for (const double friction : frictions) EXPECT_EQ(friction, frictions[0]);
}

SCREE_IN_BOTH_PRECISIONS(EnergyLedgerOf);

}  // namespace
}  // namespace scree
