// The engine's neighbour lists against every pair looked at.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "kernels/cell_grid.h"
#include "kernels/step_kernels.h"
#include "tests/oracle/beds.h"

namespace scree {
namespace {

using IdPair = std::pair<uint64_t, uint64_t>;
using IdPairs = std::map<IdPair, double>;  // and the overlap, m

double wrapped(double d, double period) { return period > 0 ? d - period * std::nearbyint(d / period) : d; }

double distance_of(const ParticleState& a, const ParticleState& b, const Vec3& period) {
  const Vec3 d = a.position - b.position;
  return norm(Vec3{wrapped(d.x, period.x), wrapped(d.y, period.y), wrapped(d.z, period.z)});
}

IdPairs every_touching_pair(const std::vector<ParticleState>& all, const Vec3& period) {
  IdPairs result;
  for (size_t a = 0; a < all.size(); ++a)
    for (size_t b = a + 1; b < all.size(); ++b) {
      const double overlap = all[a].radius + all[b].radius - distance_of(all[a], all[b], period);
      if (overlap > 0) result[std::minmax(all[a].id, all[b].id)] = overlap;
    }
  return result;
}

// Lists hold for the positions before the last step's move: pairs that may have met in it are asked for by neither
// side. Returns the number of pairs compared.
size_t expect_all_pairs_listed(const Engine& engine, const Vec3& period, const std::string& what) {
  const double slack = 2.001 * engine.max_speed() * engine.dt() + 1e-15;
  const IdPairs oracle = every_touching_pair(engine.particles(), period);
  IdPairs listed;
  for (const Engine::TouchingPair& p : engine.touching_pairs())
    EXPECT_TRUE(listed.emplace(std::minmax(p.i, p.j), p.overlap).second)
        << what << ": pair listed twice: " << p.i << ", " << p.j;
  size_t compared = 0;
  for (const auto& [pair, overlap] : oracle) {
    if (overlap <= slack) continue;
    ++compared;
    const auto found = listed.find(pair);
    EXPECT_TRUE(found != listed.end()) << what << ": missing " << pair.first << ", " << pair.second << ", overlap "
                                       << overlap;
    if (found != listed.end()) {
      EXPECT_NEAR(found->second, overlap, 1e-14) << what;
    }
  }
  for (const auto& [pair, overlap] : listed)
    if (overlap > slack) {
      EXPECT_TRUE(oracle.contains(pair)) << what << ": not touching " << pair.first << ", " << pair.second;
    }
  return compared;
}

// Particles hardly move in one step of this length, so exactly the given positions are searched.
constexpr double kNoTime = 1e-12;

// Deep overlaps fail a step; its lists stand all the same.
void step_once(Engine& engine) {
  try {
    engine.step();
  } catch (const RunError&) {
  }
}

size_t expect_static_search_right(Case c, const std::vector<ParticleState>& particles, const std::string& what,
                                  double skin = 0) {
  c.time.step = kNoTime;
  size_t compared = 0;
  for (const Precision precision : {Precision::mixed, Precision::reference}) {
    c.contact.precision = precision;
    const auto engine = make_engine(c, with_skin(skin));
    engine->insert(particles);
    step_once(*engine);
    EXPECT_EQ(engine->count(), particles.size());
    compared = expect_all_pairs_listed(*engine, periods(c), what);
    if (::testing::Test::HasFailure()) break;
  }
  return compared;
}

std::vector<ParticleState> random_spheres(const Bounds& box, size_t count, double smallest, double largest,
                                          uint32_t seed) {
  Random random(seed);
  std::vector<ParticleState> result;
  while (result.size() < count) {
    const Vec3 x = random.in(box);
    // As many small as large ones by volume, roughly: the sizes are evenly spread on a logarithmic scale.
    result.push_back(grain(x, smallest * std::pow(largest / smallest, random.between(0, 1))));
  }
  return result;
}

Bounds cube(double side) { return {{-0.3 * side, 0, 0.1 * side}, {0.7 * side, side, 1.1 * side}}; }

TEST(Neighbours, OfRandomDensePackingsAreAllFound) {
  for (uint32_t seed = 1; seed <= 3; ++seed)
    for (const std::set<char>& periodic : {std::set<char>{}, std::set<char>{'x', 'y', 'z'}}) {
      const Case c = ceramic_case(cube(5e-3), periodic);
      EXPECT_GT(expect_static_search_right(c, random_spheres(c.domain, 2300, kRadius, kRadius, seed),
                                           fmt::format("seed {}", seed)),
                3000u);
    }
}

TEST(Neighbours, OfSparseParticlesAreAllFound) {
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    const Case c = ceramic_case(cube(0.1 * seed * seed), {'y'});
    std::vector<ParticleState> particles = random_spheres(c.domain, 300, kRadius, kRadius, seed);
    const size_t alone = particles.size();
    for (size_t k = 0; k < alone; ++k) particles.push_back(grain(particles[k].position + Vec3{0, 1.9 * kRadius, 0}));
    EXPECT_GE(expect_static_search_right(c, particles, "sparse"), alone);
  }
}

TEST(Neighbours, OfAllSizesOneToTenAreAllFound) {
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const Case c = ceramic_case(cube(10e-3), seed % 2 ? std::set<char>{} : std::set<char>{'x', 'z'});
    EXPECT_GT(expect_static_search_right(c, random_spheres(c.domain, 1500, 1e-4, 1e-3, seed), "1:10"), 3000u);
    EXPECT_GT(expect_static_search_right(c, random_spheres(c.domain, 1500, 1e-4, 1e-3, seed), "1:10, thin skin", 1e-8),
              3000u);
  }
}

TEST(Neighbours, AcrossPeriodicBordersOfSmallBoxesAreAllFound) {
  const double cutoff = 2 * kRadius + 0.4 * kRadius;  // skin of particles at rest
  for (const std::set<char>& periodic :
       {std::set<char>{'x'}, std::set<char>{'y'}, std::set<char>{'z'}, std::set<char>{'x', 'y'},
        std::set<char>{'y', 'z'}, std::set<char>{'x', 'y', 'z'}})
    for (const double cells : {2.0001, 2.5, 3.0001, 3.9, 4.2}) {
      const Case c = ceramic_case(cube(cells * cutoff), periodic);
      const auto particles =
          random_spheres(c.domain, static_cast<size_t>(3 * cells * cells * cells), kRadius, kRadius, 7);
      EXPECT_GT(expect_static_search_right(c, particles, fmt::format("{} cutoffs, {} axes", cells, periodic.size())),
                particles.size() / 2);
    }
}

// A pair within reach at two images may be listed once only: it would push twice.
TEST(Neighbours, InAPeriodicBoxBarelyAboveTwoDiametersPushOnce) {
  Case wide = ceramic_case({{0, 0, 0}, {0.01, 0.01, 0.01}}),
       tight = ceramic_case({{0, 0, 0}, {4.2 * kRadius, 0.01, 0.01}}, {'x'});
  std::vector<Vec3> velocity;
  for (const Case& c : {wide, tight}) {
    const auto engine = make_engine(c);
    engine->insert(std::vector{grain({1e-4, 5e-3, 5e-3}), grain({1e-4 + 1.98 * kRadius, 5e-3, 5e-3})});
    try {
      engine->step();
    } catch (const RunError&) {
      SUCCEED();  // a refusal is an answer too
      return;
    }
    EXPECT_EQ(engine->touching_pairs().size(), 1u);
    velocity.push_back(by_id(*engine)[0].velocity);
  }
  EXPECT_LT(velocity[0].x, 0);
  EXPECT_FLOAT_EQ(velocity[1].x, velocity[0].x);
}

// Powers of two, so that every second particle lies exactly on a cell's border.
TEST(Neighbours, OnCellBordersAreAllFound) {
  const double radius = 0x1p-12, skin = 0x1p-12, cell = 2 * radius + skin, pitch = cell / 2;
  for (const std::set<char>& periodic : {std::set<char>{}, std::set<char>{'x', 'y', 'z'}})
    for (const int n : {4, 6, 10}) {
      const Case c = ceramic_case({{0, 0, 0}, {n * pitch, n * pitch, n * pitch}}, periodic);
      std::vector<ParticleState> particles;
      for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x) particles.push_back(grain(pitch * Vec3{double(x), double(y), double(z)}, radius));
      const size_t lines = periodic.empty() ? n - 1 : n;
      EXPECT_EQ(expect_static_search_right(c, particles, fmt::format("{}^3", n), skin), 3 * lines * n * n);
      // And with one cell between neighbours: listed at most, touching none.
      Case far = ceramic_case({{0, 0, 0}, {n * cell, n * cell, n * cell}}, periodic);
      for (ParticleState& p : particles) p.position = 2.0 * p.position;
      EXPECT_EQ(expect_static_search_right(far, particles, "one per cell", skin), 0u);
    }
}

TEST(Neighbours, AlmostCoincidentAreAllFound) {
  Random random(5);
  std::vector<ParticleState> particles;
  const Case c = ceramic_case(cube(5e-3));
  for (int heap = 0; heap < 20; ++heap) {
    const Vec3 x = random.in(c.domain);
    for (int k = 0; k < 15; ++k) particles.push_back(grain(x + 1e-10 * random.in({{-1, -1, -1}, {1, 1, 1}})));
  }
  EXPECT_GE(expect_static_search_right(c, particles, "heaps"), 20u * 15 * 14 / 2);
}

TEST(Neighbours, ExactlyCoincidentEndTheRunWithAnError) {
  const auto engine = make_engine(ceramic_case(cube(5e-3)));
  engine->insert(std::vector{grain({0, 1e-3, 1e-3}), grain({0, 1e-3, 1e-3})});
  EXPECT_THROW(engine->step(), RunError);
}

TEST(Neighbours, AtChunkBoundariesAreAllFound) {
  for (const size_t count : {255, 256, 257, 511, 512, 513, 2560, 2561}) {
    const double side = 2 * kRadius * std::cbrt(static_cast<double>(count));
    const Case c = ceramic_case(cube(side), {'x', 'y', 'z'});
    EXPECT_GT(expect_static_search_right(c, random_spheres(c.domain, count, kRadius, kRadius, 3),
                                         fmt::format("N = {}", count)),
              count);
  }
}

TEST(Neighbours, OfNoneOneAndTwoParticles) {
  const Case c = ceramic_case(cube(5e-3), {'z'});
  EXPECT_EQ(expect_static_search_right(c, {grain({0, 1e-3, 1e-3})}, "one"), 0u);
  EXPECT_EQ(expect_static_search_right(c, {grain({0, 1e-3, 1e-3}), grain({0, 1e-3, 1.3e-3})}, "two"), 1u);
  EXPECT_EQ(
      expect_static_search_right(c, {grain({0, 1e-3, 0.5e-3 + 1e-5}), grain({0, 1e-3, 5.5e-3 - 1e-5})}, "two, wrapped"),
      1u);
  // All of them leave, then one comes back.
  const auto engine = make_engine(c);
  engine->insert(std::vector{grain({0, 1e-3, 1e-3})});
  engine->set_removal([](const ParticleState& p) { return p.position.y < 2e-3 ? 0 : -1; });
  run_steps(*engine, 3);
  EXPECT_EQ(engine->count(), 0u);
  engine->insert(std::vector{grain({0, 3e-3, 1e-3})});
  run_steps(*engine, 3);
  EXPECT_EQ(engine->count(), 1u);
}

// In a process of its own with an alarm: what went wrong here once never ended.
TEST(NeighboursDeathTest, StepsBeforeTheFirstParticleComesPass) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto step_without_particles = [] {
    alarm(10);
    const auto engine = make_engine(ceramic_case(cube(5e-3)));
    run_steps(*engine, 3);
    std::exit(engine->count() == 0 && engine->touching_pairs().empty() ? 0 : 1);
  };
  EXPECT_EXIT(step_without_particles(), ::testing::ExitedWithCode(0), "");
}

// A bed that falls, and comes to rest: the skin goes with the speeds, at each renewal of the lists.
TEST(Neighbours, AreListedWithASkinThatGoesWithTheSpeeds) {
  const LooseBed bed{6, 6, 8, kRadius, kRadius, 3.2};
  const auto engine = make_engine(bed_case(bed));
  engine->insert(bed.particles({0, 0, 0}, 3));
  engine->step();
  const double begun = engine->skin();
  run_steps(*engine, 2500);
  const double falling = engine->skin();
  run_steps(*engine, 20000);
  engine->insert({}), engine->step();  // renewed
  const double resting = engine->skin();
  EXPECT_GT(falling, 1.5 * begun);
  EXPECT_LT(resting, falling / 1.5);
  EXPECT_GT(resting, 0);
}

// A gas at speeds that need many rebuilds, chosen skin and thin skin.
TEST(Neighbours, OfAFastGasAreNeverMissed) {
  for (const double skin : {0.0, 1e-5})
    for (const std::set<char>& periodic : {std::set<char>{'x', 'y', 'z'}, std::set<char>{'x', 'y'}}) {
      const LooseBed bed{8, 8, 8, 0.5 * kRadius, 1.5 * kRadius, 2.3};
      const double side = 8 * bed.pitch();
      Case c = ceramic_case({{0, 0, 0}, {side, side, side}}, periodic);
      c.time.step = 1e-6;
      c.pairs[0].restitution = 1, c.pairs[1].restitution = 1;
      c.solid.walls = {"ends"};
      if (periodic.size() == 2)
        c.solid.primitives =
            box_walls(c.domain, {.x_min = false, .x_max = false, .y_min = false, .y_max = false}, {1, 0});
      auto particles = bed.particles({0, 0, 0}, 11);
      Random random(12);
      // Most pairs meet head-on at twice the largest speed: the bound on their travel has nothing to spare.
      for (ParticleState& p : particles)
        p.velocity = {random.below(2) ? 1.0 : -1.0, random.between(-0.02, 0.02), random.between(-0.02, 0.02)};
      if (periodic.size() == 2) c.domain.min.z -= kRadius, c.domain.max.z += kRadius;
      const auto engine = make_engine(c, with_skin(skin));
      engine->insert(particles);
      size_t compared = 0;
      for (int check = 0; check < 300; ++check) {
        run_steps(*engine, 1 + check % 3);
        compared += expect_all_pairs_listed(*engine, periods(c),
                                            fmt::format("skin {}, step {}", skin, engine->counters().steps));
        if (HasFailure()) return;
      }
      EXPECT_GT(compared, 500u);
      EXPECT_GT(engine->counters().rebuilds, 8u);
    }
}

TEST(Neighbours, AfterInsertionsAndRemovalsAreAllFound) {
  const LooseBed bed{10, 10, 3};
  Case c = bed_case({10, 10, 12});
  const auto engine = make_engine(c);
  engine->insert(bed.particles({0, 0, 0}, 1));
  double removed_from = 1;  // m, particles with x beyond leave
  engine->set_removal([&](const ParticleState& p) { return p.position.x > removed_from ? 0 : -1; });
  size_t compared = 0;
  for (int wave = 1; wave < 4; ++wave) {
    run_steps(*engine, 1500);
    compared += expect_all_pairs_listed(*engine, periods(c), fmt::format("before wave {}", wave));
    if (wave == 2) removed_from = 2.9e-3;
    engine->insert(bed.particles({0, 0, 3 * wave * bed.pitch()}, 1 + wave));
    run_steps(*engine, 1);
    compared += expect_all_pairs_listed(*engine, periods(c), fmt::format("after wave {}", wave));
  }
  EXPECT_GT(compared, 500u);
  EXPECT_GT(engine->counters().removed, 100u);
  EXPECT_EQ(engine->count() + engine->counters().removed, 1200u);
}

// ---- the search alone: what is listed, active, near or far, and where

struct Listed {
  std::map<std::pair<uint32_t, uint32_t>, std::set<uint32_t>> owners;  // pair of indices, the chunks that list it
  std::map<std::pair<uint32_t, uint32_t>, size_t> active, far;         // by how many chunks
};

struct SearchScene {
  std::vector<Particle<float>> particles;  // in cell order once searched
  double period[3] = {0, 0, 0};
  Bounds box;
  double skin, inner;
  uint32_t chunk;
  double middle() const { return 0.5 * (skin + inner); }

  Listed search(const std::string& isa) {
    CellGrid grid;
    float largest = 0;
    for (const auto& p : particles) largest = std::max(largest, p.radius);
    grid.lay(box, period, 2.0 * largest + skin, 4096);
    const auto code = [&](const Particle<float>& p) { return grid.morton(grid.cell_of({p.x, p.y, p.z})); };
    std::ranges::stable_sort(particles, {}, code);
    const uint32_t count = static_cast<uint32_t>(particles.size());
    for (uint32_t k = 0; k < count; ++k) {
      CellGrid::Range& range = grid.ranges[grid.linear(grid.cell_of({particles[k].x, particles[k].y, particles[k].z}))];
      if (range.end == 0) range.begin = k;
      range.end = k + 1;
    }
    const auto kernels = select_kernels<float>(isa, {});
    const std::vector<uint32_t> old_index(count, 0xffffffffu);
    const HistoryTable<float> no_history;
    Listed result;
    for (uint32_t begin = 0; begin < count; begin += chunk) {
      ChunkContacts<float> contacts;
      contacts.clear(begin, std::min(count, begin + chunk), count);
      const uint32_t end = std::min(count, begin + chunk);
      kernels.search({particles.data(), begin, end, count, &grid, skin, middle(), inner, old_index.data(), &no_history,
                      &contacts});
      const auto take = [&](uint32_t i, uint32_t j) {
        EXPECT_TRUE(i >= begin && i < end);
        EXPECT_TRUE(j > i || j < begin);
        EXPECT_TRUE(result.owners[std::minmax(i, j)].insert(begin / chunk).second) << "listed twice in one chunk";
      };
      for (uint32_t k = 0; k < contacts.pairs; ++k) {
        const uint32_t i = contacts.pair_i(k), j = contacts.pair_j(k);
        take(i, j);
        ++result.active[std::minmax(i, j)];
        const uint32_t row = contacts.blocks[k / kBlock].row[k % kBlock];
        EXPECT_EQ(row, j >= begin && j < end ? j - begin : end - begin);
        if (k < contacts.first_wrapping * kBlock) {
          for (int a = 0; a < 3; ++a)
            EXPECT_LT(std::abs((&particles[i].x)[a] - (&particles[j].x)[a]), period[a] > 0 ? 0.5 * period[a] : 1e9);
        }
      }
      for (const WaitingPair& pair : contacts.near) take(pair.i, pair.j);
      for (const WaitingPair& pair : contacts.far) {
        take(pair.i, pair.j);
        ++result.far[std::minmax(pair.i, pair.j)];
      }
      for (uint32_t k = contacts.pairs; k < contacts.blocks.size() * kBlock; ++k) {
        EXPECT_EQ(contacts.pair_i(k), begin);
        EXPECT_EQ(contacts.pair_j(k), count);
        EXPECT_EQ(contacts.blocks[k / kBlock].row[k % kBlock], end - begin);
      }
    }
    return result;
  }

  double gap(uint32_t a, uint32_t b) const {
    const Vec3 d{wrapped(particles[a].x - particles[b].x, period[0]),
                 wrapped(particles[a].y - particles[b].y, period[1]),
                 wrapped(particles[a].z - particles[b].z, period[2])};
    return norm(d) - particles[a].radius - particles[b].radius;
  }
};

void expect_search_right(SearchScene scene, const std::string& what) {
  for (const std::string& isa : available_isas()) {
    const Listed listed = scene.search(isa);
    const uint32_t count = static_cast<uint32_t>(scene.particles.size());
    size_t wanted = 0;
    const double size = 2.0 * scene.particles[0].radius + scene.skin, extra = 1e-3 * size;
    for (uint32_t a = 0; a < count; ++a)
      for (uint32_t b = a + 1; b < count; ++b) {
        const double gap = scene.gap(a, b);
        const auto found = listed.owners.find({a, b});
        wanted += gap <= scene.skin;
        if (found == listed.owners.end()) {
          ASSERT_GT(gap, scene.skin) << what << ", " << isa << ": a pair is missing";
          continue;
        }
        ASSERT_LE(gap, scene.skin + extra) << what << ", " << isa;
        // At the very edge, where rounding decides, one chunk may list a pair and the other not.
        const std::set<uint32_t> owners{a / scene.chunk, b / scene.chunk};
        ASSERT_TRUE(found->second == owners || gap > scene.skin)
            << what << ", " << isa << ": each chunk with one of the two owns the pair; gap " << gap;
        const auto active = listed.active.find({a, b});
        const size_t active_owners = active == listed.active.end() ? 0 : active->second;
        ASSERT_TRUE(active_owners == owners.size() || gap > scene.inner) << what << ", " << isa;
        ASSERT_TRUE(active_owners == 0 || gap <= scene.inner + extra) << what << ", " << isa;
        const auto far = listed.far.find({a, b});
        const size_t far_owners = far == listed.far.end() ? 0 : far->second;
        ASSERT_TRUE(far_owners == 0 || gap > scene.middle() - extra) << what << ", " << isa;
        ASSERT_TRUE(far_owners == owners.size() || gap <= scene.middle() + extra || gap > scene.skin) << what;
      }
    EXPECT_GT(wanted, 0u);
  }
}

Particle<float> record(const Vec3& x, double radius) {
  Particle<float> p{};
  p.x = x.x, p.y = x.y, p.z = x.z, p.radius = static_cast<float>(radius), p.inverse_mass = 1;
  return p;
}

TEST(PairSearch, ListsCoincidentParticles) {
  SearchScene scene{{}, {0, 0, 0}, {{0, 0, 0}, {1, 1, 1}}, 0.02, 0.004, 7};
  Random random(1);
  for (int heap = 0; heap < 12; ++heap) {
    const Vec3 x = random.in(scene.box);
    for (int k = 0; k < 1 + heap * 2; ++k) scene.particles.push_back(record(x, 0.05));
  }
  expect_search_right(scene, "coincident");
}

TEST(PairSearch, ListsPairsOfAGridOnCellBorders) {
  for (const bool periodic : {false, true})
    for (const double pitch : {0x1p-4, 0x1p-5, 0x1p-3}) {  // cells are 0x1p-4
      SearchScene scene{{}, {0, 0, 0}, {{0, 0, 0}, {0.5, 0.5, 0.5}}, 0x1p-5, 0x1p-6, 64};
      for (double& period : scene.period) period = periodic ? 0.5 : 0;
      for (double z = 0; z < 0.5; z += pitch)
        for (double y = 0; y < 0.5; y += 2 * pitch)
          for (double x = 0; x < 0.5; x += pitch) scene.particles.push_back(record({x, y, z}, 0x1p-6));
      if (pitch > 0x1p-4) scene.particles.push_back(record({0, 0, 0x1p-5}, 0x1p-6));
      expect_search_right(scene, fmt::format("pitch {}, periodic {}", pitch, periodic));
    }
}

TEST(PairSearch, ListsRandomPairsOfAllSizes) {
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    SearchScene scene{{},       {0, 0, 0}, {{-1, -1, -1}, {0, 0, 0}}, seed % 2 ? 0.02 : 1e-5, seed % 2 ? 0.004 : 1e-5,
                      seed * 37};
    if (seed % 3 != 0) scene.period[seed % 3] = 1;
    Random random(seed);
    scene.particles.push_back(record(random.in(scene.box), 0.1));
    for (int k = 0; k < 700; ++k)
      scene.particles.push_back(record(random.in(scene.box), 0.1 * std::pow(10, -random.between(0, 1))));
    expect_search_right(scene, fmt::format("seed {}", seed));
  }
}

// Far from the origin positions must not lose their digits: 1 mm grains 1 km away.
TEST(PairSearch, IsAsSharpFarFromTheOrigin) {
  const Vec3 far{1000, -1000, 1000};
  SearchScene scene{{}, {0, 0, 0}, {far, far + Vec3{0.02, 0.02, 0.02}}, 2e-4, 4e-5, 100};
  Random random(9);
  for (int k = 0; k < 900; ++k) scene.particles.push_back(record(random.in(scene.box), 5e-4));
  expect_search_right(scene, "far");
}

}  // namespace
}  // namespace scree
