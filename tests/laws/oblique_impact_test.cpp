// Oblique impacts of elastic spheres against MFIX's verification case DEM05 (MFIX documentation, Verification and
// Validation Manual, DEM05; Hertzian spring-dashpot columns), which repeats the experiments of Kharaz, Gorham & Salman
// (2001), Powder Technology 120:281: aluminium oxide spheres of 5 mm at 3.9 m/s, friction 0.092, on a glass anvil and
// on each other. Its law is the one used here with e = 1.
#include "tests/laws/impact.h"

namespace scree {
namespace {

class ObliqueImpact : public LawTest {};
SCREE_IN_BOTH_PRECISIONS(ObliqueImpact);

struct Row {
  double angle_deg;       // of incidence, from the normal
  double restitution[2];  // tangential, of the centre: of two spheres, on the wall
  double spin[2];         // rad/s
  double rebound_deg[2];  // of the centre
};
const Row kTable[] = {
    {2.5, {0.9979, 0.9967}, {0.3564, 0.5631}, {2.4947, 2.4917}},
    {5, {0.9436, 0.9400}, {19.0839, 20.2515}, {4.7195, 4.7015}},
    {7.5, {0.7809, 0.7775}, {111.1390, 112.5553}, {5.8696, 5.8442}},
    {10, {0.6933, 0.6903}, {206.9487, 208.3846}, {6.9697, 6.9401}},
    {15, {0.6258, 0.6236}, {376.3819, 377.6207}, {9.5189, 9.4858}},
    {20, {0.6166, 0.6150}, {509.7637, 510.5268}, {12.6481, 12.6178}},
    {25, {0.6351, 0.6343}, {599.5880, 599.5303}, {16.4967, 16.4771}},
    {30, {0.6813, 0.6813}, {619.6944, 618.3861}, {21.4722, 21.4722}},
    {35, {0.7372, 0.7372}, {586.2264, 585.0427}, {27.3031, 27.3031}},
    {40, {0.7807, 0.7807}, {548.2978, 547.2487}, {33.2288, 33.2288}},
    {50, {0.8456, 0.8456}, {460.2321, 459.4671}, {45.2213, 45.2213}},
    {60, {0.8938, 0.8938}, {358.1432, 357.6565}, {57.1386, 57.1386}},
    {65, {0.9142, 0.9142}, {302.7855, 302.4259}, {62.9751, 62.9751}},
};
const Material kOxide{"aluminium oxide", 4000, 380e9, 0.23};
const Material kAnvil{"glass anvil", 0, 70e9, 0.25};
constexpr double kRadius = 0.0025, kSpeed = 3.9, kFriction = 0.092;

// How far a row may be from the table: restitution, spin in rad/s, rebound angle in degrees.
struct Tolerance {
  double restitution, spin, rebound_deg;
};
void expect_table(int column, const Tolerance& tolerance, Precision precision) {
  const ImpactBodies bodies{kOxide, kAnvil, kRadius, 1, kFriction};
  for (const Row& row : kTable) {
    const double vt = kSpeed * std::sin(degrees(row.angle_deg)), vn = kSpeed * std::cos(degrees(row.angle_deg));
    const ParticleState p = strike_wall(bodies, {vt, 0, -vn}, {0, 0, 0}, precision).first;
    const double rebound_deg = std::atan2(p.velocity.x, p.velocity.z) * 180 / std::numbers::pi;
    EXPECT_NEAR(p.velocity.x / vt, row.restitution[column], tolerance.restitution) << row.angle_deg << " degrees";
    EXPECT_NEAR(norm(p.spin), row.spin[column], tolerance.spin) << row.angle_deg << " degrees";
    EXPECT_NEAR(rebound_deg, row.rebound_deg[column], tolerance.rebound_deg) << row.angle_deg << " degrees";
  }
}

// MFIX's two spheres keep their line of centres, so they are a sphere and a wall; their lever arm is R - overlap / 2,
// as here: 0.1 % of the largest spin.
TEST_P(ObliqueImpact, LeverArmToTheMiddleOfTheOverlapAsMfixDem05) { expect_table(0, {2e-3, 0.62, 6e-3}, GetParam()); }

// With a wall, MFIX's lever arm is R - overlap: 0.3 % apart.
TEST_P(ObliqueImpact, SphereOnWallAsMfixDem05) { expect_table(1, {5e-3, 1.6, 0.036}, GetParam()); }

}  // namespace
}  // namespace scree
