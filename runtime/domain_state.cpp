// The domain's state out to a checkpoint and back, bit for bit: particles in storage order and the lists as they are,
// so that the next rebuild comes when it would have come.
#include "runtime/domain.h"
#include "runtime/state_archive.h"

namespace scree {

template <class Real>
void Domain<Real>::save(StateWriter& out) const {
  for_each_field([&](const char* name, auto member) { out.save(std::string("engine/") + name, this->*member); });
  out.array("engine/particles", std::span(now_.data(), count_));
  if (!lists_valid_) out.save("engine/history", history_);
}

template <class Real>
void Domain<Real>::load(StateReader& in) {
  for_each_field([&](const char* name, auto member) { in.load(std::string("engine/") + name, this->*member); });
  require_sound_numbers();
  const uint32_t count = std::exchange(count_, 0);
  require_state(in.size<Particle<Real>>("engine/particles") == count, "the number of its particles is another");
  reserve(count);
  count_ = count;
  in.array("engine/particles", std::span(now_.data(), count_));
  require_sound_particles();
  place_dummies(now_), place_dummies(next_);

  Solid left{solid_.walls, {}};
  for (const uint32_t k : solid_identity_) left.primitives.push_back(solid_.primitives[k]);
  solid_ = std::move(left);
  if (!lists_valid_) {
    in.load("engine/history", history_);
    return require_sound_history();
  }
  outcomes_.resize(chunks());
  index_solid();  // the slots name rows of its tables
  require_sound_lists();
}

template class Domain<float>;
template class Domain<double>;

}  // namespace scree
