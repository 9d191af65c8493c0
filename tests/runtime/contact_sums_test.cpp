// Force, coordination and stress of particles from their contacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "kernels/parallel.h"
#include "tests/scenes.h"

namespace scree {
namespace {

using std::numbers::pi;

constexpr double kRadius = 0.001;

Case glass_case(Precision precision) {
  Case c = empty_case(1e-6, precision);
  add_material(c, {"glass", 2500, 1e8, 0.25});
  add_kind(c, 0, kRadius);
  c.pairs = {{0, 0, 0.3, 0, 0}};
  return c;
}

double volume(double r) { return 4.0 / 3 * pi * r * r * r; }

// Hertz: F = 4/3 E* sqrt(R*) overlap^1.5 along x, at R - overlap/2 from each centre.
TEST(ContactSums, OfTwoSpheresPressedTogetherAreHertzsForceOnItsBranch) {
  const Case c = glass_case(Precision::reference);
  const double overlap = 1e-6, distance = 2 * kRadius - overlap;
  const std::vector<ParticleState> pair = {sphere(c, 0, {0, 0, 0}), sphere(c, 0, {distance, 0, 0})};
  const auto engine = make_engine(c);
  engine->insert(pair);
  engine->step();
  const std::vector<ParticleState> now = engine->particles();
  const std::vector<ContactState> contacts = engine->contacts();
  ASSERT_EQ(contacts.size(), 1u);
  const auto sums = engine->contact_sums();
  const double stiff = 1e8 / (2 * (1 - 0.25 * 0.25)), d = contacts[0].overlap;
  const double hertz = 4.0 / 3 * stiff * std::sqrt(kRadius / 2) * std::pow(d, 1.5);
  for (size_t k = 0; k < 2; ++k) {
    const double side = now[k].position.x > 0.5 * distance ? 1 : -1;
    EXPECT_NEAR(sums[k].force.x, side * hertz, 0.02 * hertz);  // damping, too: they move apart by now
    EXPECT_NEAR(sums[k].force.x, side * norm(contacts[0].force), 1e-15);
    EXPECT_NEAR(sums[k].stress[0], norm(contacts[0].force) * (kRadius - 0.5 * d) / volume(kRadius),
                1e-6 * sums[k].stress[0]);
    for (int i = 1; i < 6; ++i) EXPECT_NEAR(sums[k].stress[i], 0, 1e-9);
    EXPECT_EQ(sums[k].coordination, 1);
    EXPECT_EQ(sums[k].wall_contacts, 0);
  }
}

TEST(ContactSums, OfAPairAcrossAPeriodicFaceAreTheSame) {
  Case c = glass_case(Precision::reference);
  c.domain = {{0, 0, 0}, {0.01, 0.01, 0.01}}, c.periodic[0] = true;
  const std::vector<ParticleState> pair = {sphere(c, 0, {0.01 - 0.9995e-3, 0.005, 0.005}),
                                           sphere(c, 0, {0.9995e-3, 0.005, 0.005})};
  const auto engine = make_engine(c);
  engine->insert(pair);
  engine->step();
  const std::vector<ContactState> contacts = engine->contacts();
  ASSERT_EQ(contacts.size(), 1u);
  const auto sums = engine->contact_sums();
  const double expected = norm(contacts[0].force) * (kRadius - 0.5 * contacts[0].overlap) / volume(kRadius);
  for (size_t k = 0; k < 2; ++k) EXPECT_NEAR(sums[k].stress[0], expected, 1e-6 * expected);
}

// Spheres one on the other: W above and W + m g below one of them, each at R from its centre, so that
// s_zz = R (2 W + m g) / V: three halves of the weight on its cross-section, for it fills two thirds of its cylinder.
// And over the whole column, sum V s_zz = sum m g z.
TEST(ContactSums, StressOfARestingColumnCarriesTheWeightAbove) {
  for (const Precision precision : {Precision::reference, Precision::mixed}) {
    Case c = glass_case(precision);
    c.time.step = 4e-6;
    c.gravity = {0, 0, -9.81};
    add_solid(c, floor_at(0, 0.01, 0));
    std::vector<ParticleState> column;
    for (int k = 0; k < 6; ++k) column.push_back(sphere(c, 0, {0, 0, kRadius * (1 + 2 * k)}));
    const auto engine = make_engine(c);
    engine->insert(column);
    for (int k = 0; k < 20000; ++k) engine->step();
    std::vector<ParticleState> now = engine->particles();
    const auto sums = engine->contact_sums();
    const double weight = now[0].mass * 9.81;
    double total = 0, moment = 0;
    for (size_t k = 0; k < now.size(); ++k) {
      const double above = weight * static_cast<double>(5 - now[k].id), area = pi * kRadius * kRadius;
      SCOPED_TRACE(now[k].id);
      EXPECT_NEAR(sums[k].force.z, weight, 0.01 * weight);
      EXPECT_NEAR(sums[k].stress[2], 1.5 * (above + 0.5 * weight) / area, 0.01 * (above + weight) / area);
      EXPECT_NEAR(sums[k].stress[0], 0, 1e-6 * weight / area);
      EXPECT_EQ(sums[k].wall_contacts, now[k].id == 0 ? 1 : 0);
      EXPECT_EQ(sums[k].coordination, now[k].id == 0 || now[k].id == 5 ? 1 : 2);
      total += volume(kRadius) * sums[k].stress[2], moment += weight * now[k].position.z;
    }
    EXPECT_NEAR(total, moment, 0.005 * moment);
  }
}

// Grains pressed together on a floor, under crossed fibres, over periodic borders; of one material, or of two and two
// radii. Summed by the list of contacts.
TEST(ContactSums, AreThoseOfTheContactsOneByOne) {
  for (const Precision precision : {Precision::reference, Precision::mixed})
    for (const bool two_materials : {false, true}) {
      Case c = glass_case(precision);
      if (two_materials) {
        add_material(c, {"soft", 2500, 5e7, 0.3});
        add_kind(c, 1, 1.003 * kRadius);
        c.pairs.push_back({0, 1, 0.5, 0.2, 0}), c.pairs.push_back({1, 1, 0.6, 0.3, 0});
      }
      c.domain = {{0, 0, -0.01}, {0.0199, 0.0199, 0.04}}, c.periodic[0] = c.periodic[1] = true;
      add_solid(c, floor_at(0, 0.05, 0));
      const double over = 0.000995 + 9 * 0.00199 + kRadius + 0.0005 - 5e-6;  // the fibres' axes, in the highest grains
      c.solid.primitives.push_back({Segment{{0, 0.00199, over}, {0.0199, 0.00199, over}}, 0.0005, 0, 0});
      c.solid.primitives.push_back({Segment{{0.00398, 0, over}, {0.00398, 0.0199, over}}, 0.0005, 0, 0});
      std::vector<ParticleState> grains;
      for (int k = 0; k < 1000; ++k)  // ten by ten, half a per cent nearer than touching; the floor nearer, too
        grains.push_back(
            sphere(c, two_materials ? k % 2 : 0,
                   {0.00199 * (k % 10) + 1e-6 * (k % 7), 0.00199 * (k / 10 % 10), 0.000995 + 0.00199 * (k / 100)},
                   {0.01 * (k % 3), 0, -0.01}, {1.0 * (k % 5), 2, 3}));
      const auto engine = make_engine(c);
      engine->insert(grains);
      for (int k = 0; k < 3; ++k) engine->step();
      const std::vector<ParticleState> now = engine->particles();
      std::vector<ContactSum> expected(now.size());
      double most_force = 0, most_stress = 0;
      const auto add = [&](size_t k, const Vec3& arm, const Vec3& f) {  // arm: from the centre to the point
        const double s = -1 / volume(now[k].radius);
        const double product[] = {arm.x * f.x,
                                  arm.y * f.y,
                                  arm.z * f.z,
                                  (arm.x * f.y + arm.y * f.x) / 2,
                                  (arm.y * f.z + arm.z * f.y) / 2,
                                  (arm.x * f.z + arm.z * f.x) / 2};
        expected[k].force += f;
        for (int i = 0; i < 6; ++i) expected[k].stress[i] += static_cast<float>(s * product[i]);
        most_force = std::max(most_force, norm(f)), most_stress = std::max(most_stress, std::abs(s * product[2]));
      };
      for (const ContactState& t : engine->contacts()) {
        add(t.i, -(now[t.i].radius - (t.with_solid ? 1 : 0.5) * t.overlap) * t.normal, t.force);
        ++(t.with_solid ? expected[t.i].wall_contacts : expected[t.i].coordination);
        if (t.with_solid) continue;
        add(t.j, (now[t.j].radius - 0.5 * t.overlap) * t.normal, -t.force);
        ++expected[t.j].coordination;
      }
      const auto sums = engine->contact_sums();
      int pairs = 0, walls = 0;
      for (size_t k = 0; k < now.size(); ++k) {
        EXPECT_EQ(sums[k].coordination, expected[k].coordination) << k;
        EXPECT_EQ(sums[k].wall_contacts, expected[k].wall_contacts) << k;
        EXPECT_LT(norm(sums[k].force - expected[k].force), 1e-6 * most_force) << k;
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(sums[k].stress[i], expected[k].stress[i], 1e-6 * most_stress) << k;
        pairs += sums[k].coordination, walls += sums[k].wall_contacts;
      }
      EXPECT_GT(pairs, 4000);
      EXPECT_GE(walls, 100 + 18);
    }
}

TEST(ContactSums, CoordinationCountsTouchingPairs) {
  Case c = glass_case(Precision::mixed);
  c.time.step = 5e-6, c.pairs[0].sliding_friction = 0.5;
  c.gravity = {0, 0, -9.81};
  add_solid(c, floor_at(0, 0.05, 0));
  std::vector<ParticleState> grains;
  for (int k = 0; k < 125; ++k)
    grains.push_back(sphere(
        c, 0, {0.0021 * (k % 5) + 1e-5 * (k % 7), 0.0021 * (k / 5 % 5) + 1e-5 * (k % 3), 0.0011 + 0.0021 * (k / 25)}));
  const auto engine = make_engine(c);
  engine->insert(grains);
  for (int k = 0; k < 15000; ++k) engine->step();
  const std::vector<ParticleState> now = engine->particles();
  const auto sums = engine->contact_sums();
  std::map<uint64_t, int> expected;
  for (const Engine::TouchingPair& pair : engine->touching_pairs()) ++expected[pair.i], ++expected[pair.j];
  int all = 0;
  for (size_t k = 0; k < now.size(); ++k) {
    EXPECT_EQ(sums[k].coordination, expected[now[k].id]) << now[k].id;
    all += sums[k].coordination;
  }
  EXPECT_GT(all, 30);
}

TEST(ContactSums, AreTheSameForAnyNumberOfThreads) {
  Case c = glass_case(Precision::mixed);
  std::vector<ParticleState> grains;
  for (int k = 0; k < 3375; ++k)  // pressed together by some per cent
    grains.push_back(sphere(c, 0, {0.00199 * (k % 15), 0.00197 * (k / 15 % 15), 0.00198 * (k / 225)}));
  const auto engine = make_engine(c);
  engine->insert(grains);
  engine->step();
  const int before = thread_count();
  const auto sums = [&](int threads) {
    set_thread_count(threads);
    return engine->contact_sums();
  };
  const auto one = sums(1), three = sums(3);
  set_thread_count(before);
  ASSERT_EQ(one.capacity(), three.capacity());
  EXPECT_GT(std::ranges::max(std::span(one.data(), one.capacity()), {}, &ContactSum::coordination).coordination, 5);
  for (size_t k = 0; k < one.capacity(); ++k) {
    EXPECT_EQ(one[k].coordination, three[k].coordination) << k;
    EXPECT_EQ(one[k].stress, three[k].stress) << k;
    EXPECT_EQ(norm(one[k].force - three[k].force), 0) << k;
  }
}

}  // namespace
}  // namespace scree
