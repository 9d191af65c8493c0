#include "runtime/particle_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernels/parallel.h"
#include "runtime/case_physics.h"

namespace scree {

namespace {

using Column = ParticleSnapshot::Column;

constexpr double kMostRounding = 1e-4;  // of a radius, of positions in single precision

template <class T>
std::array<T, 3> row_of(const Vec3& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

// What the rows are made of, but for the particles: those come some at a time.
struct Source {
  bool contacts_known = false;
  Array<ContactSum> sums;  // empty: unknown, or no field asks for it
  double time = 0, dt = 0;
  const std::vector<Insertion>& insertions;

  double age(uint64_t id) const {
    const auto after = std::ranges::upper_bound(insertions, id, {}, &Insertion::first_id);
    return time - static_cast<double>((after - 1)->step) * dt;
  }
};

// Some particles, one after the other.
struct Rows {
  const Source& of;
  size_t first, count;                       // in the engine's order
  size_t place;                              // of the first in the columns
  std::span<const ParticleState> particles;  // none where all columns come from contacts
};

// get(k) is a row, of each of them.
template <class Get>
void fill(Column& c, const Rows& rows, const Get& get) {
  using Row = decltype(get(size_t{}));
  char* to = c.values.data() + rows.place * sizeof(Row);
  for (size_t k = 0; k < rows.count; ++k, to += sizeof(Row)) {
    const Row row = get(k);
    std::memcpy(to, &row, sizeof row);
  }
}

// get(particle)
template <class Get>
void fill_of_particles(Column& c, const Rows& rows, const Get& get) {
  fill(c, rows, [&](size_t k) { return get(rows.particles[k]); });
}

// get(the particle's sums)
template <class Row, class Get>
void fill_of_contacts(Column& c, const Rows& rows, const Row& unknown, const Get& get) {
  fill(c, rows, [&](size_t k) -> Row { return rows.of.contacts_known ? get(rows.of.sums[rows.first + k]) : unknown; });
}

using Fill = void (*)(Column&, const Rows&);

struct Field {
  const char* name;
  int components;
  bool from_contacts, in_files;
  ElementType type;
  Fill fill;
};

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, 3> kUnknownVector{kUnknown, kUnknown, kUnknown};
constexpr std::array<float, 6> kUnknownTensor{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
constexpr int16_t kUnknownCount = -1;
constexpr ElementType kReal = element_type<float>(), kCount = element_type<int16_t>();

const std::array kFields = {
    Field{"velocity", 3, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return row_of<float>(p.velocity); });
          }},
    Field{"angular_velocity", 3, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return row_of<float>(p.spin); });
          }},
    Field{"force", 3, true, true, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_contacts(c, rows, kUnknownVector, [](const ContactSum& sum) { return row_of<float>(sum.force); });
          }},
    Field{"coordination", 1, true, true, kCount,
          [](Column& c, const Rows& rows) {
            fill_of_contacts(c, rows, kUnknownCount,
                             [](const ContactSum& sum) { return static_cast<int16_t>(sum.coordination); });
          }},
    Field{"wall_contacts", 1, true, true, kCount,
          [](Column& c, const Rows& rows) {
            fill_of_contacts(c, rows, kUnknownCount,
                             [](const ContactSum& sum) { return static_cast<int16_t>(sum.wall_contacts); });
          }},
    Field{"contact_stress", 6, true, true, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_contacts(c, rows, kUnknownTensor, [](const ContactSum& sum) { return sum.stress; });
          }},
    Field{"age", 1, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [&](const ParticleState& p) { return static_cast<float>(rows.of.age(p.id)); });
          }},
    Field{"mass", 1, false, false, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return static_cast<float>(p.mass); });
          }},
};

// Those that every snapshot has come first.
template <class Coordinate>
Field points() {
  return {"Points", 3, false, true, element_type<Coordinate>(), [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return row_of<Coordinate>(p.position); });
          }};
}
const std::array kAlways = {
    Field{"id", 1, false, true, element_type<uint32_t>(),
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return static_cast<uint32_t>(p.id); });
          }},
    Field{"radius", 1, false, true, kReal,
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return static_cast<float>(p.radius); });
          }},
    Field{"kind", 1, false, true, element_type<uint8_t>(),
          [](Column& c, const Rows& rows) {
            fill_of_particles(c, rows, [](const ParticleState& p) { return static_cast<uint8_t>(p.kind); });
          }},
};

bool needs_double_points(const Case& c) {
  double reach = 0;  // m, of a coordinate
  for (const Vec3& corner : {c.domain.min, c.domain.max})
    for (const double x : {corner.x, corner.y, corner.z}) reach = std::max(reach, std::abs(x));
  return reach * 0x1p-24 > kMostRounding * smallest_radius(c);
}

std::vector<Field> fields_of(const Case& c, const std::vector<std::string>& names) {
  std::vector<Field> fields{needs_double_points(c) ? points<double>() : points<float>()};
  fields.insert(fields.end(), kAlways.begin(), kAlways.end());
  for (const Field& field : kFields)
    if (std::ranges::find(names, field.name) != names.end()) fields.push_back(field);
  return fields;
}

Source source_of(const Engine& engine, std::span<const Field> fields) {
  Source source{engine.knows_contacts(), {}, engine.time(), engine.dt(), engine.insertions()};
  if (std::ranges::any_of(fields, &Field::from_contacts)) source.sums = engine.contact_sums();
  return source;
}

std::vector<Column> empty_columns(std::span<const Field> fields) {
  std::vector<Column> columns;
  for (const Field& f : fields)
    columns.push_back({f.name, f.type, f.components > 1 ? static_cast<uint64_t>(f.components) : 0, {}});
  return columns;
}

// Rows of the particles from `begin` to `end`. All columns of some particles before the next: what is made of each is
// in the cache, and of all at no time.
void fill_columns(std::span<Column> columns, std::span<const Field> fields, const Engine& engine, const Source& source,
                  size_t begin, size_t end) {
  constexpr size_t kAtOnce = 1024;
  for (Column& c : columns) c.values.allocate((end - begin) * std::max<uint64_t>(c.components, 1) * c.type.size);
  const bool of_contacts = std::ranges::all_of(fields, &Field::from_contacts);
  parallel_for((end - begin + kAtOnce - 1) / kAtOnce, [&](size_t part) {
    const size_t first = begin + part * kAtOnce, last = std::min(end, first + kAtOnce);
    std::vector<ParticleState> particles;
    particles.reserve(last - first);
    for (size_t k = first; k < last && !of_contacts; ++k) particles.push_back(engine.particle(k));
    for (size_t k = 0; k < columns.size(); ++k)
      fields[k].fill(columns[k], {source, first, last - first, first - begin, particles});
  });
}

PlainArray array_of(const Column& c, const void* values, uint64_t rows) {
  return plain_array(c.name == "Points" ? c.name : "PointData/" + c.name, c.type, values,
                     rows * std::max<uint64_t>(c.components, 1), c.components);
}

// Some pieces of each column, on all threads, before the next.
void pack_columns(std::span<const Field> fields, const Engine& engine, const Source& source,
                  std::span<PackedArray* const> to) {
  if (fields.empty() || engine.count() == 0) return;
  const uint64_t piece_rows = to[0]->piece_rows, pieces = std::max(2, thread_count());
  std::vector<Column> columns = empty_columns(fields);
  for (uint64_t first = 0; first < engine.count(); first += pieces * piece_rows) {
    const uint64_t last = std::min<uint64_t>(engine.count(), first + pieces * piece_rows);
    fill_columns(columns, fields, engine, source, first, last);
    std::vector<PlainArray> parts;
    for (const Column& c : columns) {
      parts.push_back(array_of(c, c.values.data(), last - first));
      parts.back().piece_rows = piece_rows;
    }
    pack_pieces(parts, first / piece_rows, to);
  }
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

ParticleSnapshot::ParticleSnapshot(const Case& c, const Engine& engine, const std::vector<std::string>& names)
    : particles_(engine.count()) {
  const std::vector<Field> fields = fields_of(c, names);
  columns_ = empty_columns(fields);
  fill_columns(columns_, fields, engine, source_of(engine, fields), 0, engine.count());
}

std::vector<PackedArray> packed_particles(const ParticleSnapshot& snapshot, const std::function<void()>& beside) {
  const VertexCells cells(snapshot.particles());
  std::vector<PlainArray> arrays = cells.arrays();
  for (const Column& column : snapshot.columns())
    arrays.push_back(array_of(column, column.values.data(), snapshot.particles()));
  return packed(arrays, beside);
}

std::vector<PackedArray> packed_particles(const Case& c, const Engine& engine, const std::vector<std::string>& names) {
  std::vector<PackedArray> frame = packed(VertexCells(engine.count()).arrays());
  const size_t cells = frame.size();
  const std::vector<Field> fields = fields_of(c, names);
  for (const Column& column : empty_columns(fields))
    frame.push_back(without_pieces(array_of(column, nullptr, engine.count())));
  // Those of contacts first, so that the sums of all particles are gone when the others come.
  for (const bool of_contacts : {true, false}) {
    std::vector<Field> some;
    std::vector<PackedArray*> to;
    for (size_t k = 0; k < fields.size(); ++k)
      if (fields[k].from_contacts == of_contacts) some.push_back(fields[k]), to.push_back(&frame[cells + k]);
    pack_columns(some, engine, source_of(engine, some), to);
  }
  return frame;
}

}  // namespace scree
