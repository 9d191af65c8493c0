// Engine::contacts(): what observers see is what moves the particles.
#include <gtest/gtest.h>

#include "kernels/parallel.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

// Grains on a lid above a small lattice, some in its fibres, at rest but for what the last bounces left.
Case grains_on_fibres(Precision precision) {
  Case c = ceramic_case({{-0.005, -0.005, -0.012}, {0.005, 0.005, 0.02}});
  c.contact.precision = precision;
  c.gravity = {0, 0, -9.81};
  add_small_lattice(c);
  return c;
}

std::unique_ptr<Engine> settled(const Case& c) {
  std::unique_ptr<Engine> engine = make_engine(c);
  std::vector<ParticleState> grains = LooseBed{8, 8, 4}.particles({-0.0034, -0.0034, 0.004}, 1);
  const std::vector<ParticleState> inside = LooseBed{5, 5, 3}.particles({-0.0021, -0.0021, -0.0028}, 2);
  grains.insert(grains.end(), inside.begin(), inside.end());
  std::erase_if(grains, [&](const ParticleState& g) {
    return std::ranges::any_of(c.solid.primitives,
                               [&](const Primitive& p) { return distance(p, g.position) < g.radius; });
  });
  engine->insert(grains);
  run_steps(*engine, 12000);
  return engine;
}

class ContactsIn : public testing::TestWithParam<Precision> {};

TEST_P(ContactsIn, forces_are_those_that_the_next_step_applies) {
  const Case c = grains_on_fibres(GetParam());
  const std::unique_ptr<Engine> engine = settled(c);
  const std::vector<ParticleState> before = engine->particles();
  const std::vector<ContactState> contacts = engine->contacts();
  std::vector<Vec3> force(before.size(), Vec3{0, 0, 0});
  size_t with_fibres = 0;
  for (const ContactState& k : contacts) {
    force[k.i] += k.force;
    if (!k.with_solid) force[k.j] = force[k.j] - k.force;
    with_fibres += k.with_solid && c.solid.primitives[k.j].radius > 0;
  }
  ASSERT_GT(contacts.size(), before.size());
  ASSERT_GT(with_fibres, 10u);

  // Single precision rounds the velocities that the accelerations are differences of.
  const double tolerance = GetParam() == Precision::mixed ? 1e-3 : 1e-9;
  engine->step();
  const std::vector<ParticleState> after = by_id(*engine);
  for (size_t i = 0; i < before.size(); ++i) {
    const ParticleState& b = before[i];
    const double weight = b.mass * 9.81;
    const Vec3 applied = (b.mass / engine->dt()) * (after[b.id].velocity - b.velocity) - b.mass * c.gravity;
    EXPECT_LT(norm(applied - force[i]), 1e-4 * weight + tolerance * norm(force[i]));
  }
}

TEST_P(ContactsIn, overlap_point_and_normal_fit_together) {
  const Case c = grains_on_fibres(GetParam());
  const std::unique_ptr<Engine> engine = settled(c);
  const std::vector<ParticleState> all = engine->particles();
  for (const ContactState& k : engine->contacts()) {
    const ParticleState& i = all[k.i];
    ASSERT_GT(k.overlap, 0);
    EXPECT_NEAR(norm(k.normal), 1, 1e-6);
    EXPECT_NEAR(dot(k.slip, k.normal), 0, 1e-6 + 1e-5 * norm(k.slip));
    if (k.with_solid) {
      EXPECT_NEAR(distance(c.solid.primitives[k.j], k.point), 0, 1e-9);
      EXPECT_NEAR(norm(i.position - k.point), i.radius - k.overlap, 1e-9);
    } else {
      const ParticleState& j = all[k.j];
      EXPECT_NEAR(norm(i.position - j.position), i.radius + j.radius - k.overlap, 1e-9);
      EXPECT_NEAR(norm(i.position - k.point), i.radius - 0.5 * k.overlap, 1e-9);
    }
  }
}

TEST(Contacts, are_the_same_list_for_any_number_of_threads) {
  const Case c = grains_on_fibres(Precision::mixed);
  const std::unique_ptr<Engine> engine = settled(c);
  set_thread_count(1);
  const std::vector<ContactState> one = engine->contacts();
  set_thread_count(3);
  const std::vector<ContactState> three = engine->contacts();
  ASSERT_EQ(one.size(), three.size());
  for (size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].i, three[k].i);
    EXPECT_EQ(one[k].j, three[k].j);
    EXPECT_EQ(one[k].overlap, three[k].overlap);
    EXPECT_EQ(one[k].force.z, three[k].force.z);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ContactsIn, testing::Values(Precision::mixed, Precision::reference),
                         [](const auto& info) { return info.param == Precision::mixed ? "mixed" : "reference"; });

}  // namespace
}  // namespace scree
