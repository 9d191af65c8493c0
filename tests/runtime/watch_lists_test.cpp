// A missed rebuild: contacts that the lists do not hold are found, by cells and by brute force.
#include "tests/runtime/watch.h"

namespace scree {
namespace {

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

}  // namespace
}  // namespace scree
