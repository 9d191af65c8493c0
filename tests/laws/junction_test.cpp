// The solid is the union of its primitives: what is buried in it is not felt, what is one point is felt once, and no
// seam is felt at all.
//
// Forces are read from the first step of a sphere that starts at rest: it kicks by half a step, with no history and no
// gravity, so m v / (dt / 2) is Hertz's force. Directions are tried at copies of the node far from one another, one
// sphere each, in one run.
#include <algorithm>
#include <random>

#include "tests/laws/law_test.h"

namespace scree {
namespace {

class Junction : public LawTest {
 protected:
  static constexpr double kRadius = 0x1p-12, kThickness = 0.001, kOverlap = 0x1p-18;  // R 0.244 mm, overlap R/64

  Case base_case(double step = 1e-6) const {
    Case c = empty_case(step, GetParam());
    add_material(c, {"grain", 2500, 1e7, 0.3}), add_material(c, {"solid", 0, 1e7, 0.3});
    c.pairs = {{0, 1, 0.5, 0.5, 0.2}};
    c.contact.rolling = RollingModel::epsd2;
    add_kind(c, 0, kRadius);
    return c;
  }
  // Forces on spheres at rest at these places.
  static std::vector<Vec3> forces(const Case& c, const std::vector<Vec3>& places) {
    std::vector<ParticleState> spheres;
    for (const Vec3& x : places) spheres.push_back(sphere(c, 0, x));
    Simulation run(c, spheres);
    run.step();
    std::vector<Vec3> result;
    for (const ParticleState& p : run.in_order()) result.push_back((2 * p.mass / c.time.step) * p.velocity);
    return result;
  }
  static double hertz_force(const Case& c, double overlap) {
    return 4.0 / 3.0 * constants_of(c, 0, 1).effective_youngs * std::sqrt(kRadius) * std::pow(overlap, 1.5);
  }
  // What single-precision forces and positions of R may differ by.
  static double accuracy() { return GetParam() == Precision::reference ? 1e-10 : 2e-6; }
};
SCREE_IN_BOTH_PRECISIONS(Junction);

// Directions in which the fibres of a node go: those of the Octet lattice and parts of it.
std::vector<Vec3> octet_directions() {
  std::vector<Vec3> all;
  for (int a = 0; a < 3; ++a)
    for (const double s : {-1.0, 1.0})
      for (const double t : {-1.0, 1.0}) {
        double d[3] = {0, 0, 0};
        d[a] = s, d[(a + 1) % 3] = t;
        all.push_back(unit(Vec3{d[0], d[1], d[2]}));
      }
  return all;
}
const std::vector<std::vector<Vec3>> kNodes = {
    {{1, 0, 0}, {0, 1, 0}},
    {{1, 0, 0}, {-1, 0, 0}},
    {unit(Vec3{1, 2, 2}), unit(Vec3{1, 2.2, 2})},
    {{1, 0, 0}, unit(Vec3{-1, 1, 0}), unit(Vec3{-1, -1, 0.5})},
    octet_directions(),
};

constexpr double kLength = 0.005, kPitch = 0.02;

// A copy of the node at every place, each fibre of kLength.
void add_nodes(Case& c, const std::vector<Vec3>& directions, const std::vector<Vec3>& places, double thickness) {
  for (const Vec3& x : places) {
    std::vector<Segment> axes;
    for (size_t k = 0; k < directions.size(); ++k)  // some begin at the node, some end there
      axes.push_back(k % 2 ? Segment{x + kLength * directions[k], x} : Segment{x, x + kLength * directions[k]});
    add_solid(c, fibre_network(axes, thickness, {1, 0}));
  }
}
std::vector<Vec3> grid_of_places(size_t count) {
  std::vector<Vec3> places;
  for (size_t k = 0; k < count; ++k)
    places.push_back({kPitch * (k % 16), kPitch * (k / 16 % 16), kPitch * static_cast<double>(k / 256)});
  return places;
}
std::vector<Vec3> random_directions(size_t count) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Vec3> all;
  for (size_t k = 0; k < count; ++k) {
    const double x = normal(random), y = normal(random), z = normal(random);
    all.push_back(unit(Vec3{x, y, z}));
  }
  return all;
}

// The union by the book, from distances to axes: contact points inside another fibre do not count, coinciding ones
// count once. `x` from the node.
Vec3 union_force(const std::vector<Vec3>& directions, const Vec3& x, double reach, double radius, const auto& hertz) {
  const auto foot = [&](const Vec3& d, const Vec3& p) { return std::clamp(dot(p, d), 0.0, kLength) * d; };
  std::vector<Vec3> points;
  Vec3 force{0, 0, 0};
  for (const Vec3& d : directions) {
    const Vec3 from_axis = x - foot(d, x), normal = unit(from_axis);
    const double overlap = reach - norm(from_axis);
    if (overlap <= 0) continue;
    const Vec3 point = foot(d, x) + radius * normal;
    const bool buried = std::any_of(directions.begin(), directions.end(), [&](const Vec3& other) {
      return norm(point - foot(other, point)) < radius * (1 - 1e-12);
    });
    const bool known =
        std::any_of(points.begin(), points.end(), [&](const Vec3& p) { return norm(p - point) < 1e-12 * radius; });
    if (buried || known) continue;
    points.push_back(point);
    force += hertz(overlap) * normal;
  }
  return force;
}

// The point on the ray from the node that is this far from the nearest fibre's axis.
Vec3 pressed(const std::vector<Vec3>& node, const Vec3& toward, double distance) {
  double low = 0, high = 2 * kLength;
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    double nearest = 1e300;
    for (const Vec3& d : node) {
      const Vec3 x = middle * toward;
      nearest = std::min(nearest, norm(x - std::clamp(dot(x, d), 0.0, kLength) * d));
    }
    (nearest < distance ? low : high) = middle;
  }
  return low * toward;
}

// Where no fibre goes, the node is one sphere of the fibres' thickness, however many meet in it.
TEST_P(Junction, CapOfANodeIsOneSphere) {
  for (const auto& node : kNodes) {
    std::vector<Vec3> outward;
    for (const Vec3& u : random_directions(4000))
      if (std::all_of(node.begin(), node.end(), [&](const Vec3& d) { return dot(u, d) < -1e-3; })) outward.push_back(u);
    if (outward.empty()) continue;  // fibres on every side
    if (outward.size() > 250) outward.resize(250);
    Case c = base_case();
    std::vector<Vec3> places = grid_of_places(outward.size());
    add_nodes(c, node, places, kThickness);
    for (size_t k = 0; k < places.size(); ++k) places[k] += (kRadius + kThickness / 2 - kOverlap) * outward[k];
    const std::vector<Vec3> f = forces(c, places);
    for (size_t k = 0; k < places.size(); ++k)
      ASSERT_LT(norm(f[k] - hertz_force(c, kOverlap) * outward[k]) / hertz_force(c, kOverlap), accuracy())
          << node.size() << " fibres, direction " << outward[k].x << ' ' << outward[k].y << ' ' << outward[k].z;
  }
}

// From any direction, at any small distance from the node: the force of the union.
TEST_P(Junction, NodeIsTheUnionOfItsFibres) {
  for (const auto& node : kNodes) {
    const std::vector<Vec3> toward = random_directions(500);
    Case c = base_case();
    std::vector<Vec3> places = grid_of_places(toward.size()), from_node;
    add_nodes(c, node, places, kThickness);
    const double reach = kRadius + kThickness / 2;
    for (size_t k = 0; k < places.size(); ++k) {
      from_node.push_back(pressed(node, toward[k], reach - kOverlap));
      places[k] += from_node[k];
    }
    const std::vector<Vec3> f = forces(c, places);
    for (size_t k = 0; k < places.size(); ++k) {
      const Vec3 expected =
          union_force(node, from_node[k], reach, kThickness / 2, [&](double o) { return hertz_force(c, o); });
      ASSERT_GT(norm(expected), 0);
      ASSERT_LT(norm(f[k] - expected) / hertz_force(c, kOverlap), 10 * accuracy())
          << node.size() << " fibres, direction " << toward[k].x << ' ' << toward[k].y << ' ' << toward[k].z;
    }
  }
}

// Close to where contacts change from one fibre to another, tolerances decide which contact stays: one must.
TEST_P(Junction, OneContactAtLeastStaysNearTheBorders) {
  for (const auto& node : {kNodes[0], kNodes[3], kNodes[4]}) {
    std::vector<Vec3> toward;
    std::mt19937 random(5);
    const auto signed_size = [&] {
      return (random() % 2 ? 1.0 : -1.0) * std::pow(10, -5 + 3 * (random() / 4294967296.0));
    };
    for (size_t a = 0; a < node.size(); ++a)
      for (size_t b = a + 1; b < node.size(); ++b) {
        const Vec3 border = cross(node[a], node[b]);  // both fibres' caps end here
        if (norm(border) < 1e-6) continue;
        for (int n = 0; n < 40; ++n) {
          const double side = n % 2 ? 1 : -1;
          const Vec3 u = side * unit(border);
          toward.push_back(unit(u + Vec3{signed_size(), signed_size(), signed_size()}));
        }
      }
    Case c = base_case();
    std::vector<Vec3> places = grid_of_places(toward.size());
    add_nodes(c, node, places, kThickness);
    for (size_t k = 0; k < places.size(); ++k)
      places[k] += pressed(node, toward[k], kRadius + kThickness / 2 - kOverlap);
    const std::vector<Vec3> f = forces(c, places);
    size_t lost = 0;
    for (size_t k = 0; k < places.size(); ++k) {
      const double along = norm(f[k]) / hertz_force(c, kOverlap);
      lost += along < 0.99;
      if (along < 0.99 && lost < 4)
        ADD_FAILURE() << node.size() << " fibres, direction " << toward[k].x << ' ' << toward[k].y << ' ' << toward[k].z
                      << ": " << along;
    }
    EXPECT_EQ(lost, 0u) << "of " << places.size();
  }
}

// Two crossing fibres that share no node; a sphere in the corner between them rests on both.
TEST_P(Junction, ConcaveCornerIsFeltOnBothSides) {
  Case c = base_case();
  const std::vector<Segment> axes = {{{-0.01, 0, 0}, {0.01, 0, 0}}, {{0, -0.01, 0}, {0, 0.01, 0}}};
  add_solid(c, fibre_network(axes, kThickness, {1, 0}));
  const double reach = kRadius + kThickness / 2 - kOverlap;
  // At (s, s, z): each axis at the distance sqrt(s^2 + z^2).
  for (const double s : {0.3, 0.6, 0.9}) {
    const double a = s * reach, z = std::sqrt(reach * reach - a * a), f = hertz_force(c, kOverlap);
    const Vec3 force = forces(c, {{a, a, z}})[0];
    const Vec3 expected{f * a / reach, f * a / reach, 2 * f * z / reach};
    EXPECT_LT(norm(force - expected) / f, 2 * accuracy()) << s;
  }
}

// A fibre whose axis lies in a wall: its upper half stands out of the wall. A sphere pressed on its ridge touches the
// wall only inside the fibre; beside it, both.
TEST_P(Junction, WallUnderAFibreIsNotFelt) {
  Case c = base_case();
  const double thin = 0.2 * kRadius;  // so thin that a sphere on the ridge reaches the wall
  const Segment axis{{-0.01, 0, 0}, {0.01, 0, 0}};
  add_solid(c, fibre_network({&axis, 1}, thin, {1, 0}));
  add_solid(c, floor_at(0, 0.02, 1));
  const double z = kRadius - kOverlap, radius = thin / 2;
  for (const double y : {0.0, 0.05 * kRadius, 0.09 * kRadius}) {
    const Vec3 x{0.001, y, z}, normal = unit(Vec3{0, y, z});
    const double overlap = kRadius + radius - std::hypot(y, z);
    EXPECT_LT(norm(forces(c, {x})[0] - hertz_force(c, overlap) * normal) / hertz_force(c, overlap), accuracy()) << y;
  }
  const double y = std::sqrt((kRadius + radius - kOverlap) * (kRadius + radius - kOverlap) - z * z);
  const Vec3 beside = forces(c, {{0.001, y, z}})[0], normal = unit(Vec3{0, y, z});
  const double f = hertz_force(c, kOverlap);
  EXPECT_LT(norm(beside - (f * normal + Vec3{0, 0, f})) / f, 2 * accuracy());
}

// A hopper's lower rim on a channel: the edge points inwards. A sphere on it touches one point, whichever face it is
// nearer to.
TEST_P(Junction, ConvexEdgeOfWallsIsFeltOnce) {
  Case c = base_case();
  const double half = 0.005;
  // Nearer to the edge than 10 nm the two overlaps are one number in single precision, and either contact may stay.
  const double tolerance = GetParam() == Precision::reference ? 1e-10 : 5e-5;
  add_solid(c, channel({{-half, -half, -0.01}, {half, half, 0}}, {1, 0}));
  add_solid(c, frustum({0, 0, 0, 2 * half, 2 * half, 0.01, 4 * half, 4 * half}, {1, 0}));
  const double f = hertz_force(c, kOverlap);
  // The edge x = half, z = 0; faces leave it downwards and up-and-outwards.
  const Vec3 hopper_normal = unit(Vec3{-0.01, 0, half});
  for (const double angle_deg : {0.0, 0.001, 5.0, 10.0, 20.0, 25.0}) {
    const Vec3 normal{-std::cos(degrees(angle_deg)), 0, std::sin(degrees(angle_deg))};
    const Vec3 x = Vec3{half, 0.001, 0} + (kRadius - kOverlap) * normal;
    EXPECT_LT(norm(forces(c, {x})[0] - f * normal) / f, tolerance) << angle_deg;
  }
  for (const double along : {1e-9, 1e-6, 1e-4}) {
    const Vec3 up = unit(Vec3{half, 0, 0.01});
    const Vec3 above = Vec3{half, 0.001, 0} + along * up + (kRadius - kOverlap) * hopper_normal;
    EXPECT_LT(norm(forces(c, {above})[0] - f * hopper_normal) / f, tolerance) << along;
    const Vec3 below = Vec3{half - kRadius + kOverlap, 0.001, -along};
    EXPECT_LT(norm(forces(c, {below})[0] - f * Vec3{-1, 0, 0}) / f, tolerance) << along;
  }
}

TEST_P(Junction, ConcaveCornerOfWallsIsFeltOnEverySide) {
  Case c = base_case();
  add_solid(c, box_walls({{0, 0, 0}, {0.01, 0.01, 0.01}}, {}, {1, 0}));
  const double d = kRadius - kOverlap, f = hertz_force(c, kOverlap);
  EXPECT_LT(norm(forces(c, {{d, d, d}})[0] - Vec3{f, f, f}) / f, 2 * accuracy());
}

// ---- rolling over seams
// ----------------------------------------------------------------------------------------------

class Seam : public Junction {
 protected:
  // What a sphere does that rolls over the solid from x = -3 mm on, through the origin, at 0.05 m/s, pressed on by
  // gravity, with sliding and rolling friction. The solid's top is the plane through the origin that is normal to `up`.
  std::vector<ParticleState> roll(const Primitives& solid, const Vec3& along = {1, 0, 0},
                                  const Vec3& up = {0, 0, 1}) const {
    Case c = base_case(5e-6);
    c.pairs[0].rolling_friction = 0.02;
    c.gravity = -9.81 * up;
    add_solid(c, solid);
    const double weight = 9.81 * sphere_mass(kRadius, 2500), speed = 0.05;
    const double overlap = kOverlap * std::pow(weight / hertz_force(c, kOverlap), 2.0 / 3.0);
    const ParticleState start = sphere(c, 0, (kRadius - overlap) * up - 0.003 * along, speed * along,
                                       (speed / (kRadius - overlap / 2)) * cross(up, along));
    Simulation run(c, {&start, 1});
    std::vector<ParticleState> history;
    for (int k = 0; k < 2000; ++k) {
      run.step(10);
      history.push_back(run.particle(0));
    }
    return history;
  }
  // The largest difference of velocities, as a share of the speed.
  static double kick(const std::vector<ParticleState>& a, const std::vector<ParticleState>& b) {
    double worst = 0;
    for (size_t k = 0; k < a.size(); ++k)
      worst = std::max(worst, norm(a[k].velocity - b[k].velocity) + kRadius * norm(a[k].spin - b[k].spin));
    return worst / 0.05;
  }
  static constexpr double kNoKick =
      1e-11;  // a share of the speed; passing over a seam must not even be rounded differently
  static Primitives fibres_below(const std::vector<Segment>& axes) {  // their top is z = 0
    std::vector<Segment> lowered = axes;
    for (Segment& s : lowered) s.a.z -= kThickness / 2, s.b.z -= kThickness / 2;
    return fibre_network(lowered, kThickness, {1, 0});
  }
};
SCREE_IN_BOTH_PRECISIONS(Seam);

const Vec3 kWest{-0.01, 0, 0}, kEast{0.01, 0, 0};

TEST_P(Seam, NodeOfCollinearFibresIsNotFelt) {
  const std::vector<ParticleState> whole = roll(fibres_below({{kWest, kEast}}));
  EXPECT_GT(whole.back().position.x, 0.0005);  // it did cross
  EXPECT_GT(whole.back().velocity.x, 0.02);
  const Vec3 third{0.001 / 3, 0, 0}, node{0, 0, 0};
  EXPECT_LT(kick(whole, roll(fibres_below({{kWest, node}, {node, kEast}}))), kNoKick);
  EXPECT_LT(kick(whole, roll(fibres_below({{node, kWest}, {kEast, node}}))), kNoKick);
  EXPECT_LT(kick(whole, roll(fibres_below({{kEast, third}, {node, third}, {kWest, node}}))), kNoKick);
}

// Other fibres that leave the node sideways and downwards stay below what the sphere rolls on.
TEST_P(Seam, NodeWithFibresBelowIsNotFelt) {
  const std::vector<ParticleState> whole = roll(fibres_below({{kWest, kEast}}));
  const Vec3 node{0, 0, 0};
  std::vector<Segment> axes = {{kWest, node}, {node, kEast}, {node, {0, 0, -0.01}}};
  for (const double y : {-0.01, 0.01}) axes.push_back({node, {0, y, -0.01}}), axes.push_back({{0, y, 0}, node});
  EXPECT_LT(kick(whole, roll(fibres_below(axes))), kNoKick);
}

TEST_P(Seam, SharedEdgeOfCoplanarQuadsIsNotFelt) {
  const SurfaceLabel label{1, 0};
  const Primitives whole_floor = rectangle({-0.01, -0.01, 0}, {0.02, 0, 0}, {0, 0.02, 0}, label);
  const std::vector<ParticleState> whole = roll(whole_floor);
  EXPECT_GT(whole.back().position.x, 0.0005);
  Primitives halves = rectangle({-0.01, -0.01, 0}, {0.01, 0, 0}, {0, 0.02, 0}, label);
  for (const Primitive& p : rectangle({0, -0.01, 0}, {0.01, 0, 0}, {0, 0.02, 0}, label)) halves.push_back(p);
  EXPECT_LT(kick(whole, roll(halves)), kNoKick);
  // Two triangles, their shared edge crossed slantwise; then four quads that meet under the sphere's path.
  Primitives triangles;
  const Vec3 a{-0.01, -0.01, 0}, b{0.01, -0.01, 0}, c{0.01, 0.01, 0}, d{-0.01, 0.01, 0};
  for (const auto& corners : {std::array{a, b, c, c}, std::array{a, c, d, d}})
    for (const Primitive& p : quad(corners, label)) triangles.push_back(p);
  EXPECT_LT(kick(whole, roll(triangles)), kNoKick);
  Primitives quarters;
  for (const double x : {-0.01, 0.0})
    for (const double y : {-0.01, 0.0})
      for (const Primitive& p : rectangle({x, y, 0}, {0.01, 0, 0}, {0, 0.01, 0}, label)) quarters.push_back(p);
  EXPECT_LT(kick(whole, roll(quarters)), kNoKick);
}

// The same on a plane in general position, where the two halves' corners are rounded differently.
TEST_P(Seam, SharedEdgeOfSlantedQuadsIsNotFelt) {
  const Vec3 along = unit(Vec3{2, -1, 0.5}), up = unit(Vec3{1, 2, 0}), side = cross(up, along);
  const auto patch = [&](double x0, double x1) {
    return quad(
        {x0 * along - 0.01 * side, x1 * along - 0.01 * side, x1 * along + 0.01 * side, x0 * along + 0.01 * side},
        {1, 0});
  };
  const std::vector<ParticleState> whole = roll(patch(-0.01, 0.01), along, up);
  EXPECT_GT(dot(whole.back().position, along), 0.0005);
  Primitives halves = patch(-0.01, 1e-4);
  for (const Primitive& p : patch(1e-4, 0.01)) halves.push_back(p);
  EXPECT_LT(kick(whole, roll(halves, along, up)), kNoKick);
}

// A fibre that lies just under the floor's surface, crossing the path, is buried.
TEST_P(Seam, FibreUnderTheFloorIsNotFelt) {
  const Primitives whole_floor = rectangle({-0.01, -0.01, 0}, {0.02, 0, 0}, {0, 0.02, 0}, {1, 0});
  Primitives with_fibre = whole_floor;
  const Segment across{{0, -0.01, -kThickness / 2 - 0.1 * kRadius}, {0, 0.01, -kThickness / 2 - 0.1 * kRadius}};
  for (const Primitive& p : fibre_network({&across, 1}, kThickness, {1, 0})) with_fibre.push_back(p);
  EXPECT_LT(kick(roll(whole_floor), roll(with_fibre)), kNoKick);
}

}  // namespace
}  // namespace scree
