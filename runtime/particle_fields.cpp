#include "runtime/particle_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernels/parallel.h"
#include "runtime/case_physics.h"
#include "runtime/contact_sums.h"

namespace scree {

namespace {

using Column = ParticleSnapshot::Column;

constexpr double kMostRounding = 1e-4;  // of a radius, of positions in single precision

double component(const Vec3& v, uint64_t i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

// What the rows are made of, but for the particles: those come some at a time.
struct Source {
  bool contacts_known = false;
  ContactSums sums;  // empty: unknown, or no field asks for it
  double time = 0, dt = 0;
  const std::vector<Insertion>& insertions;

  double age(uint64_t id) const {
    const auto after = std::ranges::upper_bound(insertions, id, {}, &Insertion::first_id);
    return time - static_cast<double>((after - 1)->step) * dt;
  }
};

struct Rows {
  const Source& of;
  size_t first;  // row of the first particle
  std::span<const ParticleState> particles;
};

// get(particle, its row, component), for each of the rows.
template <class T, class Get>
void fill(Column& c, const Rows& rows, const Get& get) {
  const uint64_t per_row = std::max<uint64_t>(c.components, 1);
  char* to = c.values.data() + rows.first * per_row * sizeof(T);
  for (size_t k = 0; k < rows.particles.size(); ++k)
    for (uint64_t i = 0; i < per_row; ++i, to += sizeof(T)) {
      const T value = static_cast<T>(get(rows.particles[k], rows.first + k, i));
      std::memcpy(to, &value, sizeof(T));
    }
}

template <class Get>
void fill_counts(Column& c, const Rows& rows, const Get& get) {
  fill<int16_t>(c, rows, [&](const ParticleState&, size_t row, uint64_t) {
    return rows.of.contacts_known ? static_cast<int>(get(row)) : -1;
  });
}

using Fill = void (*)(Column&, const Rows&);

struct Field {
  const char* name;
  int components;
  bool from_contacts, in_files;
  ElementType type;
  Fill fill;
};

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr ElementType kReal = element_type<float>(), kCount = element_type<int16_t>();

const std::array kFields = {
    Field{"velocity", 3, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [](const ParticleState& p, size_t, uint64_t i) { return component(p.velocity, i); });
          }},
    Field{"angular_velocity", 3, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [](const ParticleState& p, size_t, uint64_t i) { return component(p.spin, i); });
          }},
    Field{"force", 3, true, true, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [&](const ParticleState&, size_t row, uint64_t i) {
              return rows.of.contacts_known ? component(rows.of.sums.force[row], i) : kUnknown;
            });
          }},
    Field{"coordination", 1, true, true, kCount,
          [](Column& c, const Rows& rows) {
            fill_counts(c, rows, [&](size_t row) { return rows.of.sums.coordination[row]; });
          }},
    Field{"wall_contacts", 1, true, true, kCount,
          [](Column& c, const Rows& rows) {
            fill_counts(c, rows, [&](size_t row) { return rows.of.sums.wall_contacts[row]; });
          }},
    Field{"contact_stress", 6, true, true, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [&](const ParticleState&, size_t row, uint64_t i) {
              return rows.of.contacts_known ? rows.of.sums.stress[row][i] : kUnknown;
            });
          }},
    Field{"age", 1, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [&](const ParticleState& p, size_t, uint64_t) { return rows.of.age(p.id); });
          }},
    Field{"mass", 1, false, false, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [](const ParticleState& p, size_t, uint64_t) { return p.mass; });
          }},
};

// Those that every snapshot has come first.
template <class Coordinate>
Field points() {
  return {"Points", 3, false, true, element_type<Coordinate>(), [](Column& c, const Rows& rows) {
            fill<Coordinate>(c, rows,
                             [](const ParticleState& p, size_t, uint64_t i) { return component(p.position, i); });
          }};
}
const std::array kAlways = {
    Field{"id", 1, false, true, element_type<uint32_t>(),
          [](Column& c, const Rows& rows) {
            fill<uint32_t>(c, rows, [](const ParticleState& p, size_t, uint64_t) { return p.id; });
          }},
    Field{"radius", 1, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill<float>(c, rows, [](const ParticleState& p, size_t, uint64_t) { return p.radius; });
          }},
    Field{"kind", 1, false, true, element_type<uint8_t>(),
          [](Column& c, const Rows& rows) {
            fill<uint8_t>(c, rows, [](const ParticleState& p, size_t, uint64_t) { return p.kind; });
          }},
};

bool needs_double_points(const Case& c) {
  double reach = 0;  // m, of a coordinate
  for (const Vec3& corner : {c.domain.min, c.domain.max})
    for (const double x : {corner.x, corner.y, corner.z}) reach = std::max(reach, std::abs(x));
  return reach * 0x1p-24 > kMostRounding * smallest_radius(c);
}

// All columns of some particles before the next: what is made of each is in the cache, and of all at no time.
void fill_columns(std::span<Column> columns, std::span<const Fill> fills, const Engine& engine, const Source& source) {
  constexpr size_t kAtOnce = 1024;
  const size_t n = engine.count();
  parallel_for((n + kAtOnce - 1) / kAtOnce, [&](size_t piece) {
    const size_t first = piece * kAtOnce, last = std::min(n, first + kAtOnce);
    std::vector<ParticleState> particles;
    particles.reserve(last - first);
    for (size_t k = first; k < last; ++k) particles.push_back(engine.particle(k));
    for (size_t k = 0; k < columns.size(); ++k) fills[k](columns[k], {source, first, particles});
  });
}

}  // namespace

std::vector<std::string> particle_field_names() {
  std::vector<std::string> names;
  for (const Field& field : kFields)
    if (field.in_files) names.push_back(field.name);
  return names;
}

std::vector<ParticleFieldForm> particle_field_forms() {
  std::vector<ParticleFieldForm> forms;
  for (const Field& field : kFields) forms.push_back({field.name, field.components});
  forms.push_back({"kind", 1});
  return forms;
}

ParticleSnapshot::ParticleSnapshot(const Case& c, const Engine& engine, const std::vector<std::string>& fields) {
  const auto wanted = [&](const Field& field) { return std::ranges::find(fields, field.name) != fields.end(); };
  Source source{engine.knows_contacts(), {}, engine.time(), engine.dt(), engine.insertions()};
  if (std::ranges::any_of(kFields, [&](const Field& f) { return f.from_contacts && wanted(f); }))
    source.sums = contact_sums(engine);
  std::vector<Fill> fills;
  const auto add = [&](const Field& f) {
    const uint64_t components = f.components > 1 ? f.components : 0;
    columns_.push_back({f.name, f.type, components, std::vector<char>(engine.count() * f.components * f.type.size)});
    fills.push_back(f.fill);
  };
  add(needs_double_points(c) ? points<double>() : points<float>());
  for (const Field& field : kAlways) add(field);
  for (const Field& field : kFields)
    if (wanted(field)) add(field);
  fill_columns(columns_, fills, engine, source);
}

std::vector<PackedArray> ParticleSnapshot::packed() const {
  const VertexCells cells(columns_.front().size() / 3);
  std::vector<PlainArray> arrays = cells.arrays();
  for (const Column& c : columns_)
    arrays.push_back(plain_array(&c == &columns_.front() ? c.name : "PointData/" + c.name, c.type, c.values.data(),
                                 c.size(), c.components));
  return scree::packed(arrays);
}

}  // namespace scree
