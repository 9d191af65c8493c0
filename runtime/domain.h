// A domain: the particles of a stretch of the Morton curve, their contacts, and the step. Real is the storage
// precision.
#pragma once

#include <array>

#include "geometry/solid_index.h"
#include "kernels/array.h"
#include "kernels/cell_grid.h"
#include "kernels/history_table.h"
#include "kernels/solid_tables.h"
#include "kernels/step_kernels.h"
#include "runtime/engine.h"

namespace scree {

inline constexpr uint32_t kChunk =
    2048;  // particles in a chunk, at most: its records and force rows fit a core's cache

inline constexpr double kBuriedShare = 0.5;  // of R_i: a centre nearer to the solid than that goes through it

template <class Real>
class Domain final : public Engine {
 public:
  Domain(const Case& c, const EngineOptions& options);

  void insert(std::span<const ParticleState> particles) override;
  void open_walls(const std::vector<uint32_t>& walls) override;
  void step() override;
  void set_removal(Removal leaves) override { leaves_ = std::move(leaves); }

  size_t count() const override { return count_; }
  double time() const override { return static_cast<double>(counters_.steps) * settings_.dt; }
  double dt() const override { return settings_.dt; }
  double max_speed() const override { return max_speed_; }
  double max_overlap() const override { return max_overlap_; }
  double skin() const override { return skin_; }
  std::string isa() const override { return isa_; }
  const EngineCounters& counters() const override { return counters_; }
  size_t bytes() const override;
  size_t step_traffic() const override;
  void save(StateWriter& out) const override;
  void load(StateReader& in) override;
  double sum(const std::function<double(const ParticleState&)>& f) const override;
  std::vector<ParticleState> particles() const override;
  uint64_t state_hash() const override;
  std::vector<TouchingPair> touching_pairs() const override;
  std::vector<ContactState> contacts(Contacts which) const override;
  void visit_contacts(const SeeContacts& see, Contacts which) const override;
  ParticleState particle(size_t k) const override { return state(k); }
  Array<ContactSum> contact_sums() const override;
  bool knows_contacts() const override { return lists_valid_; }
  double elastic_energy() const override;
  const std::vector<Insertion>& insertions() const override { return insertions_; }

 private:
  uint32_t chunks() const { return (count_ + chunk_size_ - 1) / chunk_size_; }
  uint32_t chunk_begin(size_t c) const { return static_cast<uint32_t>(c) * chunk_size_; }
  uint32_t chunk_end(size_t c) const { return std::min(count_, chunk_begin(c) + chunk_size_); }
  ParticleState state_of(const Particle<Real>& p) const;
  ParticleState state(size_t k) const { return state_of(now_[k]); }
  void reserve(size_t count);
  void place_dummies(Array<Particle<Real>>& particles);
  void index_solid();

  void rebuild();
  void choose_skin();
  void choose_gaps(size_t chunk);
  void find_chunks_beside(size_t chunk);
  void invalidate_lists();
  void gather_histories();
  Bounds occupied_bounds() const;
  void check_and_wrap();
  std::vector<uint8_t> take_out_leavers();
  void sort_particles();
  void mark_ranges();
  void search_pairs();
  void search_solids();

  ChunkTask<Real> chunk_task(size_t c, Real* rows) const;
  template <class See>
  void visit_contacts_of(size_t chunk, Contacts which, const See& see) const;
  void advance_chunks();
  void add_closing();
  void add_profile(const ChunkOutcome& all);
  void book(double& kinetic, double& potential, double (&momentum)[3], const ParticleState& s) const;

  // runtime/domain_watch.cpp
  [[noreturn]] void fail_step(const ChunkOutcome& outcome) const;
  [[noreturn]] void fail_overlap(bool pair) const;
  [[noreturn]] void fail_crowded(uint32_t particle) const;
  [[noreturn]] void fail_buried(uint32_t particle, uint32_t primitive) const;
  void check_lists() const;
  std::string wall_named(uint32_t identity) const;
  std::string wall_of_image(uint32_t primitive) const;

  // runtime/domain_check.cpp: throw StateRefused
  void require_sound_numbers() const;
  void require_sound_particles() const;
  void require_sound_history() const;
  void require_sound_lists() const;

  // The state beside the particles themselves. What is not here follows from the case, or is worked out anew by each
  // rebuild; histories only wait in history_ while the lists are not valid.
  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("count", &Domain::count_), visit("chunk_size", &Domain::chunk_size_), visit("next_id", &Domain::next_id_);
    visit("max_radius", &Domain::max_radius_), visit("min_radius", &Domain::min_radius_);
    visit("max_speed", &Domain::max_speed_), visit("max_overlap", &Domain::max_overlap_);
    visit("skin", &Domain::skin_);
    visit("travel", &Domain::travel_), visit("lists_valid", &Domain::lists_valid_),
        visit("counters", &Domain::counters_);
    visit("solid_identity", &Domain::solid_identity_), visit("contacts", &Domain::contacts_);
    visit("insertions", &Domain::insertions_);
  }

  Bounds box_;
  bool periodic_[3];
  Solid solid_;                           // what is left of the case's after walls were opened
  std::vector<uint32_t> solid_identity_;  // index in the case's list of each primitive that is left
  bool brute_force_solid_;
  uint64_t check_interval_;
  double fixed_skin_;
  double max_overlap_share_;
  uint32_t kinds_;
  bool ledger_;
  StepSettings settings_{};
  StepKernels<Real> kernels_;
  std::string isa_;
  MaterialTable<Real> materials_;
  SolidTables<Real> tables_;
  std::vector<PreparedPrimitive> prepared_;
  std::unique_ptr<SolidIndex> index_;
  Removal leaves_;

  Array<Particle<Real>> now_, next_;
  uint32_t count_ = 0, chunk_size_ = 1;
  uint64_t next_id_ = 0;
  double max_radius_ = 0, min_radius_ = 0;
  std::vector<ChunkContacts<Real>> contacts_;
  HistoryTable<Real> history_;
  CellGrid grid_;
  std::vector<uint64_t> packed_, packed_scratch_;
  std::vector<uint32_t> old_index_;
  std::vector<ChunkOutcome> outcomes_;

  double skin_ = 0;
  double travel_ = 0;  // m, bound on any particle's way since the last rebuild
  double max_speed_ = 0, max_overlap_ = 0;
  bool lists_valid_ = false;
  std::vector<Insertion> insertions_;
  EngineCounters counters_;
};

}  // namespace scree
