#include "runtime/domain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernels/parallel.h"
#include "kernels/periodic.h"
#include "kernels/touching.h"
#include "runtime/case_physics.h"
#include "runtime/timer.h"

namespace scree {

namespace {

constexpr double kWayMargin = 1 + 1e-6;  // speeds are compared in single precision

uint64_t mix(uint64_t h) {  // splitmix64's finaliser
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
  return h ^ (h >> 31);
}

}  // namespace

template <class Real>
Domain<Real>::Domain(const Case& c, const EngineOptions& options)
    : box_(c.domain),
      solid_(c.solid),
      brute_force_solid_(options.brute_force_solid),
      check_interval_(options.list_check_interval),
      fixed_skin_(options.skin > 0 ? options.skin : c.neighbour.skin),
      max_overlap_share_(c.watch.max_overlap),
      kinds_(static_cast<uint32_t>(c.kinds.size())),
      ledger_(c.output.energy_ledger) {
  for (int a = 0; a < 3; ++a) periodic_[a] = c.periodic[a];
  const Vec3 length = c.domain.max - c.domain.min;
  const double lengths[3] = {length.x, length.y, length.z}, gravity[3] = {c.gravity.x, c.gravity.y, c.gravity.z};
  settings_.dt = time_step_of(c);
  for (int a = 0; a < 3; ++a)
    settings_.gravity[a] = gravity[a], settings_.period[a] = periodic_[a] ? lengths[a] : 0,
    settings_.inverse_period[a] = periodic_[a] ? 1 / lengths[a] : 0;
  settings_.limit_attraction = c.contact.limit_attraction, settings_.profile = options.profile;
  materials_ = material_table<Real>(c);
  isa_ = std::is_same_v<Real, double> ? "reference" : options.isa.empty() ? available_isas().front() : options.isa;
  kernels_ =
      select_kernels<Real>(isa_, {c.contact.rolling, materials_.uniform_pairs && materials_.uniform_walls, ledger_});
  solid_identity_.resize(solid_.primitives.size());
  for (uint32_t k = 0; k < solid_identity_.size(); ++k) solid_identity_[k] = k;
  reserve(0);
}

template <class Real>
ParticleState Domain<Real>::state_of(const Particle<Real>& p) const {
  return {{p.x, p.y, p.z},
          {p.vx, p.vy, p.vz},
          {p.wx, p.wy, p.wz},
          static_cast<double>(p.radius),
          1.0 / static_cast<double>(p.inverse_mass),
          p.kind(),
          p.id()};
}

template <class Real>
void Domain<Real>::reserve(size_t wanted) {
  if (now_.capacity() >= wanted + 2) return;
  Array<Particle<Real>> now;
  const size_t capacity = wanted + 2 + wanted / 16;
  now.allocate(capacity);
  next_.allocate(capacity, 33 * 64);
  // Touched first by the threads that will walk them: on a machine of several sockets a page lies with its thread.
  parallel_for_each(capacity, [&](size_t k) { now[k] = next_[k] = Particle<Real>{}; });
  std::copy(now_.data(), now_.data() + count_, now.data());
  now_.swap(now);
}

// Two records that padding lanes name. A negative radius keeps every overlap with them negative (kernels/pair_pass.h).
template <class Real>
void Domain<Real>::place_dummies(Array<Particle<Real>>& particles) {
  for (uint32_t k = 0; k < 2; ++k) {
    Particle<Real> p{};
    p.x = box_.min.x - 10 - k, p.y = box_.min.y - 10, p.z = box_.min.z - 10;
    p.radius = -1, p.inverse_mass = 1;
    particles[count_ + k] = p;
  }
}

template <class Real>
void Domain<Real>::insert(std::span<const ParticleState> particles) {
  if (count_ + particles.size() > 0xfffffff0u) throw RunError("more than 4 billion particles in one domain");
  invalidate_lists();
  reserve(count_ + particles.size());
  counters_.inserted += particles.size();
  if (!particles.empty() && (insertions_.empty() || insertions_.back().step != counters_.steps))
    insertions_.push_back({next_id_, counters_.steps});
  for (const ParticleState& s : particles) {
    Particle<Real> p;
    p.x = s.position.x, p.y = s.position.y, p.z = s.position.z;
    p.tag = Particle<Real>::make_tag(s.kind, next_id_++);
    p.vx = static_cast<Real>(s.velocity.x), p.vy = static_cast<Real>(s.velocity.y),
    p.vz = static_cast<Real>(s.velocity.z);
    p.wx = static_cast<Real>(s.spin.x), p.wy = static_cast<Real>(s.spin.y), p.wz = static_cast<Real>(s.spin.z);
    p.radius = static_cast<Real>(s.radius), p.inverse_mass = static_cast<Real>(1 / s.mass);
    now_[count_++] = p;
    book(counters_.ledger.inserted_kinetic, counters_.ledger.inserted_potential, counters_.ledger.inserted_momentum,
         state_of(p));
    if (s.radius > max_radius_) max_radius_ = s.radius, index_.reset();
    min_radius_ = min_radius_ == 0 ? s.radius : std::min(min_radius_, s.radius);
    max_speed_ = std::max(max_speed_, norm(s.velocity));
  }
}

// Adds a particle's energy and momentum, as its record has them, where there is a ledger.
template <class Real>
void Domain<Real>::book(double& kinetic, double& potential, double (&momentum)[3], const ParticleState& s) const {
  if (!ledger_) return;
  kinetic += kinetic_energy(s);
  potential += potential_energy(s, {settings_.gravity[0], settings_.gravity[1], settings_.gravity[2]});
  momentum[0] += s.mass * s.velocity.x, momentum[1] += s.mass * s.velocity.y, momentum[2] += s.mass * s.velocity.z;
}

template <class Real>
void Domain<Real>::open_walls(const std::vector<uint32_t>& walls) {
  Solid left{solid_.walls, {}};
  std::vector<uint32_t> identity;
  for (size_t k = 0; k < solid_.primitives.size(); ++k) {
    if (std::find(walls.begin(), walls.end(), solid_.primitives[k].wall) != walls.end()) continue;
    left.primitives.push_back(solid_.primitives[k]);
    identity.push_back(solid_identity_[k]);
  }
  invalidate_lists();  // while the tables that the lists name still exist
  solid_ = std::move(left), solid_identity_ = std::move(identity);
  index_.reset();
}

// ---- step

template <class Real>
void Domain<Real>::step() {
  if (!lists_valid_ || 2 * travel_ >= skin_) rebuild();
  const bool first = counters_.steps == 0;
  settings_.kick = first ? 0.5 * settings_.dt : settings_.dt;
  settings_.history_dt = first ? 0 : settings_.dt;
  settings_.speed_limit = count_ ? kMaxTravelShare * min_radius_ / settings_.dt : 1;
  {
    Timer t(counters_.step_seconds);
    advance_chunks();
  }
  ChunkOutcome all;
  for (const ChunkOutcome& o : outcomes_) {
    counters_.near_checks += o.checked_near;
    all.max_speed = std::max(all.max_speed, o.max_speed);
    all.max_pair_overlap = std::max(all.max_pair_overlap, o.max_pair_overlap);
    all.max_solid_overlap = std::max(all.max_solid_overlap, o.max_solid_overlap);
    all.too_fast |= o.too_fast;
    for (int part = 0; part < kStepParts; ++part) all.seconds[part] += o.seconds[part];
    if (ledger_) counters_.ledger.steps.add(o.ledger);
  }
  add_profile(all);
  max_speed_ = all.max_speed;
  max_overlap_ = std::max(2 * all.max_pair_overlap, all.max_solid_overlap);
  travel_ += kWayMargin * max_speed_ * settings_.dt;
  add_closing();
  ++counters_.steps;
  counters_.particle_steps += count_;
  if (all.too_fast || all.max_pair_overlap > max_overlap_share_ || all.max_solid_overlap > max_overlap_share_)
    fail_step(all);
  if (check_interval_ > 0 && counters_.steps % check_interval_ == 0) check_lists();
}

// A waiting pair closes by no more than the ways of the two chunks that it lies in.
template <class Real>
void Domain<Real>::add_closing() {
  for (size_t c = 0; c < contacts_.size(); ++c) {
    double other = outcomes_[c].max_speed;
    for (const uint32_t b : contacts_[c].beside) other = std::max(other, outcomes_[b].max_speed);
    contacts_[c].add_way(kWayMargin * (outcomes_[c].max_speed + other) * settings_.dt);
  }
}

template <class Real>
void Domain<Real>::add_profile(const ChunkOutcome& all) {
  const auto of = [&](StepPart part) { return all.seconds[static_cast<int>(part)]; };
  counters_.near_check_seconds += of(StepPart::near_check), counters_.pair_seconds += of(StepPart::pairs);
  counters_.solid_seconds += of(StepPart::solids), counters_.integration_seconds += of(StepPart::integration);
}

// What one chunk's pass reads; the lists and the records that a step writes are not in it.
template <class Real>
ChunkTask<Real> Domain<Real>::chunk_task(size_t c, Real* rows) const {
  return {now_.data(),
          nullptr,
          chunk_begin(c),
          chunk_end(c),
          count_,
          nullptr,
          &materials_,
          tables_.segments.view(),
          tables_.quads.view(),
          tables_.revolutions.view(),
          &settings_,
          Look::none,
          rows};
}

template <class Real>
void Domain<Real>::advance_chunks() {
  parallel_for(chunks(), [&](size_t c) {
    alignas(64) thread_local Real rows[(kChunk + 1) * 8];
    ChunkTask<Real> task = chunk_task(c, rows);
    task.new_particles = next_.data(), task.contacts = &contacts_[c];
    task.look = contacts_[c].take_look();
    outcomes_[c] = kernels_.step(task);
  });
  now_.swap(next_);
}

// ---- what others read

template <class Real>
size_t Domain<Real>::bytes() const {
  size_t total = now_.bytes() + next_.bytes() + grid_.bytes() + (packed_.capacity() + packed_scratch_.capacity()) * 8 +
                 old_index_.capacity() * 4 + history_.bytes() + contacts_.capacity() * sizeof(contacts_[0]) +
                 outcomes_.capacity() * sizeof(outcomes_[0]) + prepared_.capacity() * sizeof(prepared_[0]) +
                 insertions_.capacity() * sizeof(insertions_[0]);
  for (const auto& c : contacts_) total += c.bytes();
  return total;
}

template <class Real>
size_t Domain<Real>::step_traffic() const {
  size_t total = size_t{count_} * sizeof(Particle<Real>);
  for (const auto& c : contacts_)
    total += c.blocks.size() * sizeof(c.blocks[0]) + c.solid_blocks.size() * sizeof(c.solid_blocks[0]) +
             c.slots.size() * sizeof(c.slots[0]);
  return 2 * total;  // once read, once written
}

template <class Real>
double Domain<Real>::sum(const std::function<double(const ParticleState&)>& f) const {
  const size_t pieces = (count_ + kChunk - 1) / kChunk;
  std::vector<double> partial(pieces, 0.0);
  parallel_for(pieces, [&](size_t c) {
    for (size_t k = c * kChunk; k < std::min<size_t>(count_, (c + 1) * kChunk); ++k) partial[c] += f(state(k));
  });
  double total = 0;
  for (double p : partial) total += p;
  return total;
}

template <class Real>
std::vector<ParticleState> Domain<Real>::particles() const {
  std::vector<ParticleState> result(count_);
  parallel_for_each(count_, [&](size_t k) { result[k] = state(k); });
  return result;
}

template <class Real>
uint64_t Domain<Real>::state_hash() const {
  const size_t pieces = (count_ + kChunk - 1) / kChunk;
  std::vector<uint64_t> partial(pieces, 0);
  parallel_for(pieces, [&](size_t c) {
    for (size_t k = c * kChunk; k < std::min<size_t>(count_, (c + 1) * kChunk); ++k) {
      const ParticleState s = state(k);
      uint64_t h = mix(s.id + 0x9e3779b97f4a7c15ull);
      for (const Vec3& v : {s.position, s.velocity, s.spin})
        for (double x : {v.x, v.y, v.z}) h = mix(h ^ std::bit_cast<uint64_t>(x));
      partial[c] += h;
    }
  });
  uint64_t total = count_;
  for (uint64_t p : partial) total += p;
  return mix(total);
}

template <class Real>
std::vector<Engine::TouchingPair> Domain<Real>::touching_pairs() const {
  std::vector<TouchingPair> result;
  for (size_t c = 0; c < contacts_.size(); ++c) {
    const auto look = [&](uint32_t i, uint32_t j) {
      if (j < chunk_begin(c)) return;  // the other chunk lists it too
      const ParticleState a = state(i), b = state(j);
      const Vec3 d = minimum_image(a.position - b.position, settings_.period, settings_.inverse_period);
      const double overlap = a.radius + b.radius - norm(d);
      if (overlap > 0) result.push_back({a.id, b.id, overlap});
    };
    for (uint32_t k = 0; k < contacts_[c].pairs; ++k) look(contacts_[c].pair_i(k), contacts_[c].pair_j(k));
    for (const WaitingPair& w : contacts_[c].near) look(w.i, w.j);
    for (const WaitingPair& w : contacts_[c].far) look(w.i, w.j);
  }
  return result;
}

template <class Real>
template <class See>
void Domain<Real>::visit_contacts_of(size_t chunk, Contacts which, const See& see) const {
  const auto pass_on = [&](const TouchingContact& t) {
    const bool solid = t.skeleton >= 0;
    if (!solid && t.j < chunk_begin(chunk)) return;  // the other chunk lists it too
    see(ContactState{t.i, solid ? tables_.identity(t.skeleton, t.j) : t.j, solid, t.overlap, t.normal, t.point, t.force,
                     t.slip, t.elastic_energy});
  };
  const ChunkTask<Real> task = chunk_task(chunk, nullptr);
  if (which == Contacts::all) visit_touching_pairs<Real>(task, contacts_[chunk], pass_on);
  visit_touching_solids<Real>(task, contacts_[chunk], pass_on);
}

template <class Real>
void Domain<Real>::visit_contacts(const SeeContacts& see, Contacts which) const {
  if (!lists_valid_) return;
  constexpr size_t kAtOnce = 64;  // chunks
  std::vector<std::vector<ContactState>> found(std::min(kAtOnce, contacts_.size()));
  for (size_t first = 0; first < contacts_.size(); first += kAtOnce) {
    const size_t last = std::min(first + kAtOnce, contacts_.size());
    parallel_for(last - first, [&](size_t k) {
      found[k].clear();
      visit_contacts_of(first + k, which, [&](const ContactState& c) { found[k].push_back(c); });
    });
    for (size_t k = 0; k < last - first; ++k) see(found[k]);
  }
}

template <class Real>
double Domain<Real>::elastic_energy() const {
  if (!lists_valid_) return 0;
  std::vector<double> of_chunks(contacts_.size());
  parallel_for(contacts_.size(), [&](size_t k) {
    visit_contacts_of(k, Contacts::all, [&](const ContactState& c) { of_chunks[k] += c.elastic_energy; });
  });
  return std::accumulate(of_chunks.begin(), of_chunks.end(), 0.0);
}

namespace {

// Of a row of sum_touching().
template <class Real>
ContactSum contact_sum_of(const Real* row, double radius) {
  ContactSum sum;
  sum.force = {row[0], row[1], row[2]};
  const double volume = 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  for (size_t k = 0; k < sum.stress.size(); ++k) sum.stress[k] = static_cast<float>(row[3 + k] / volume);
  sum.coordination = static_cast<uint16_t>(row[9]), sum.wall_contacts = static_cast<uint16_t>(row[10]);
  return sum;
}

}  // namespace

template <class Real>
Array<ContactSum> Domain<Real>::contact_sums() const {
  Array<ContactSum> sums;
  if (!knows_contacts()) return sums;
  sums.allocate(count_);
  parallel_for(contacts_.size(), [&](size_t c) {
    const size_t first = chunk_begin(c), last = chunk_end(c);
    std::vector<Real> rows(kSumRow * (last - first + 1));
    sum_touching(chunk_task(c, nullptr), contacts_[c], rows.data());
    for (size_t k = first; k < last; ++k) sums[k] = contact_sum_of(&rows[kSumRow * (k - first)], now_[k].radius);
  });
  return sums;
}

template <class Real>
std::vector<ContactState> Domain<Real>::contacts(Contacts which) const {
  std::vector<ContactState> result;
  visit_contacts([&](std::span<const ContactState> part) { result.insert(result.end(), part.begin(), part.end()); },
                 which);
  return result;
}

template class Domain<float>;
template class Domain<double>;

std::unique_ptr<Engine> make_engine(const Case& c, const EngineOptions& options) {
  if (c.contact.precision == Precision::reference) return std::make_unique<Domain<double>>(c, options);
  return std::make_unique<Domain<float>>(c, options);
}

}  // namespace scree
