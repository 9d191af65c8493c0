// Fields on a grid, averaged over time, by coarse-graining: DIR/averages/NAME.vtkhdf, pictures of slices, and what they
// say about junctions (runtime/average_junctions.h) and lanes (runtime/average_lanes.h).
//
// With w the kernel (kernels/coarse_grain.h) divided by a cell's volume, < > the mean over the looks, and v relative to
// nothing:
//
//   bulk density     rho   = < sum_i m_i w(x_i) >                    solid fraction  = < sum_i V_i w(x_i) >
//   mass flux        j     = < sum_i m_i v_i w(x_i) >                velocity  u     = j / rho
//   kinetic stress   s_k   = < sum_i m_i v_i v_i w(x_i) > - rho u u
//   contact stress   s_c   = < sum_contacts f l W >,  l from the contact's point to the particle's centre, f the force
//                    on the particle, W the mean of w along l, taken at its middle; a contact of two particles counts
//                    from either side, one with a solid from its one. Positive: compression. Made symmetric.
//   granular temperature  T = tr(s_k) / (3 rho) - (2/21 width^2 / 3) sum_ab (d_a u_b)^2
//
// The last term of T takes out what the kernel sees of a steady gradient of u as if it were fluctuation (exact for a
// linear profile and an even density); T is cut off at 0. u is the field's mean over all looks, so slow changes of the
// flow count as fluctuation. Velocities are half a step older than positions.
//
// Sources: I. Goldhirsch, Granular Matter 12 (2010) 239; T. Weinhart et al., Granular Matter 14 (2012) 289.
#pragma once

#include "runtime/average_grid.h"
#include "runtime/observer.h"

namespace scree {

// What the sums over looks come to, one entry a cell. NaN where nothing was.
struct AverageFields {
  std::vector<double> solid_fraction, bulk_density, temperature;  // 1, kg/m3, m2/s2
  std::vector<Vec3> velocity, mass_flux;                          // m/s, kg/m2/s
  std::vector<std::array<double, 6>> stress, kinetic_stress;      // Pa: xx, yy, zz, xy, yz, xz; stress: both parts
  std::vector<double> free_share;                                 // of a cell's volume that is not inside a fibre
};

// The sums themselves.
class AverageSums {
 public:
  explicit AverageSums(const CoarseGrid& grid);

  void add(const Engine& engine, const Case& c);  // one look
  uint64_t looks() const { return looks_; }
  const CoarseGrid& grid() const { return grid_; }
  AverageFields fields(const Case& c) const;

  void save(StateWriter& out, const std::string& at) const;
  void load(StateReader& in, const std::string& at);

 private:
  void add_grains(const Engine& engine);

  CoarseGrid grid_;
  std::vector<double> grains_, stresses_;  // kGrainValues, kStressValues a cell, summed over looks
  uint64_t looks_ = 0;
};

class Averages final : public Observer {
 public:
  Averages(const Case& c, const AverageSettings& settings, double dt);

  std::string name() const override { return "average_" + settings_.name; }
  const Schedule& schedule() const override { return schedule_; }
  void look(const RunView& run) override;
  void finish(const RunView& run) override;
  void save(StateWriter& out, const std::string& at) const override;
  void load(StateReader& in, const std::string& at) override;
  nlohmann::json summary() const override { return summary_; }

 private:
  AverageSettings settings_;
  Schedule schedule_;
  AverageSums sums_;
  uint64_t last_step_ = Schedule::kNever;
  double from_ = 0, to_ = 0;  // s, first and last look
  double seconds_ = 0;        // wall-clock, of all looks
  nlohmann::json summary_;
};

}  // namespace scree
