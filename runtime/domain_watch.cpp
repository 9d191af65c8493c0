// Where a domain stops because its state is not to be trusted: which particle, where, when and what to change.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kernels/periodic.h"
#include "runtime/domain.h"
#include "runtime/list_check.h"

namespace scree {

namespace {

std::string text_of(const Vec3& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", x.x, x.y, x.z); }

}  // namespace

// Overlaps were taken at the positions before the step, which are in next_ now.
template <class Real>
void Domain<Real>::fail_overlap(bool pair) const {
  double worst = 0;
  uint32_t of = 0, with = 0;
  const auto look = [&](uint32_t i, uint32_t j) {
    const ParticleState a = state_of(next_[i]), b = state_of(next_[j]);
    const double sum = a.radius + b.radius,
                 length = norm(minimum_image(a.position - b.position, settings_.period, settings_.inverse_period));
    if (const double share = (sum - length) / sum; share > worst) worst = share, of = i, with = j;
  };
  const auto look_at_solid = [&](uint32_t i) {
    const ParticleState a = state_of(next_[i]);
    std::vector<uint32_t> near;
    index_->query(a.position, a.radius, near);
    for (const uint32_t k : near)
      if (const double share = (a.radius - distance(prepared_[k], a.position)) / a.radius; share > worst)
        worst = share, of = i, with = k;
  };
  if (pair)
    for (const ChunkContacts<Real>& c : contacts_)
      for (uint32_t k = 0; k < c.pairs; ++k) look(c.pair_i(k), c.pair_j(k));
  else
    for (uint32_t i = 0; i < count_; ++i) look_at_solid(i);
  if (worst == 0)  // nothing that a case can bring about: the kernels saw one among these
    throw RunError(
        fmt::format("the overlap of a particle with {} was beyond {} at t = {:.6g} s, and none is found that "
                    "is: this is an error of the program, please report it with the case",
                    pair ? "another" : "a wall or fibre", max_overlap_share_, time()));
  const ParticleState s = state_of(next_[of]);
  throw RunError(fmt::format("particle {} at {} overlaps {} by {:.3g} of {} at t = {:.6g} s (limit {}): use a smaller "
                             "[time] step (now {:.4g} s) or a larger youngs_modulus",
                             s.id, text_of(s.position),
                             pair ? fmt::format("particle {}", state_of(next_[with]).id) : wall_of_image(with), worst,
                             pair ? "the sum of the radii" : "its radius", time(), max_overlap_share_, settings_.dt),
                 s.position);
}

// One whose velocity is not a number, or else the fastest: what the kernels' single precision finds too fast may be
// within the limit by a bit.
template <class Real>
void Domain<Real>::fail_step(const ChunkOutcome& outcome) const {
  if (!outcome.too_fast) fail_overlap(outcome.max_pair_overlap > max_overlap_share_);
  uint32_t fastest = 0;
  double most = -1;
  for (uint32_t k = 0; k < count_; ++k) {
    const ParticleState s = state(k);
    const double speed = norm(s.velocity);
    if (std::isnan(speed)) {
      const Vec3 before = state_of(next_[k]).position;
      throw RunError(
          fmt::format("the velocity of particle {}, which was at {}, is not a number at t = {:.6g} s, after a largest "
                      "overlap of {:.3g} radii: use a smaller [time] step (now {:.4g} s)",
                      s.id, text_of(before), time(), max_overlap_, settings_.dt),
          before);
    }
    if (speed > most) most = speed, fastest = k;
  }
  const ParticleState s = state(fastest);
  throw RunError(
      fmt::format("particle {} at {} moves at {:.4g} m/s at t = {:.6g} s, more than {:.4g} m/s = {} radii in a step: "
                  "use a smaller [time] step (now {:.4g} s)",
                  s.id, text_of(s.position), most, time(), settings_.speed_limit, kMaxTravelShare, settings_.dt),
      state_of(next_[fastest]).position);
}

// Between rebuilds no particle moves further than half the skin, which is less than the radius of the largest: so one
// that crosses a surface without a contact in the lists is this close to it at one rebuild at least. (Particles smaller
// than the skin could be on both sides of it at two looks; check_lists() would see their missing contact.)
template <class Real>
void Domain<Real>::fail_buried(uint32_t particle, uint32_t primitive) const {
  const ParticleState s = state(particle);
  const double off = distance(prepared_[primitive], s.position);
  throw RunError(fmt::format("particle {} of radius {:.4g} m at {} is going through {} at t = {:.6g} s: its centre is "
                             "{:.3g} m {} the surface. If it was placed there, move it; else use a smaller [time] step "
                             "(now {:.4g} s) or a larger youngs_modulus",
                             s.id, s.radius, text_of(s.position), wall_of_image(primitive), time(), std::abs(off),
                             off < 0 ? "inside" : "from", settings_.dt),
                 s.position);
}

template <class Real>
void Domain<Real>::check_lists() const {
  const auto missing =
      find_missing_contact<Real>({next_.data(), count_, chunk_size_, &contacts_, box_, settings_.period,
                                  settings_.inverse_period, max_radius_, index_.get(), &tables_, &prepared_});
  if (!missing) return;
  const ParticleState s = state_of(next_[missing->i]);
  const std::string other = missing->j ? fmt::format("particle {}", state_of(next_[*missing->j]).id)
                                       : wall_named(tables_.identity(missing->kind, missing->row));
  throw RunError(
      fmt::format("particle {} at {} touches {} at t = {:.6g} s, and the contact lists do not hold it (skin "
                  "{:.3g} m, at most {:.3g} m travelled since the rebuild): this is an error of the program, "
                  "please report it with the case; a larger [neighbour] skin may avoid it",
                  s.id, text_of(s.position), other, time(), skin_, travel_),
      s.position);
}

// By index in the case's list of primitives.
template <class Real>
std::string Domain<Real>::wall_named(uint32_t identity) const {
  const auto at = std::lower_bound(solid_identity_.begin(), solid_identity_.end(), identity) - solid_identity_.begin();
  const uint32_t wall = solid_.primitives[static_cast<size_t>(at)].wall;
  return wall < solid_.walls.size() ? fmt::format("'{}'", solid_.walls[wall]) : "a wall";
}

template <class Real>
std::string Domain<Real>::wall_of_image(uint32_t primitive) const {
  return wall_named(tables_.identity(tables_.kind[primitive], tables_.row[primitive]));
}

template class Domain<float>;
template class Domain<double>;

}  // namespace scree
