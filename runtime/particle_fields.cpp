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

template <class T, class Get>
Column column(const char* name, uint64_t components, size_t count, const Get& get) {
  const uint64_t per_row = std::max<uint64_t>(components, 1);
  Column c{name, element_type<T>(), components, std::vector<char>(count * per_row * sizeof(T))};
  parallel_for_each(count, [&](size_t k) {
    char* to = c.values.data() + k * per_row * sizeof(T);
    for (uint64_t i = 0; i < per_row; ++i, to += sizeof(T)) {
      const T value = static_cast<T>(get(k, i));
      std::memcpy(to, &value, sizeof(T));
    }
  });
  return c;
}

double component(const Vec3& v, uint64_t i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

// A moment's particles and what their contacts come to.
struct Source {
  std::vector<ParticleState> particles;
  bool contacts_known = false;
  ContactSums sums;  // empty: unknown, or no field asks for it
  double time = 0, dt = 0;
  const std::vector<Insertion>& insertions;

  template <class Get>
  Column vector(const char* name, const Get& get) const {
    return column<float>(name, 3, particles.size(), [&](size_t k, uint64_t i) { return component(get(k), i); });
  }
  template <class Get>
  Column count(const char* name, const Get& get) const {
    return column<int16_t>(name, 0, particles.size(),
                           [&](size_t k, uint64_t) { return contacts_known ? static_cast<int>(get(k)) : -1; });
  }
  double age(uint64_t id) const {
    const auto after = std::ranges::upper_bound(insertions, id, {}, &Insertion::first_id);
    return time - static_cast<double>((after - 1)->step) * dt;
  }
};

struct Field {
  const char* name;
  int components;
  bool from_contacts, in_files;
  Column (*make)(const Source&, const char* name);
};

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

const std::array kFields = {
    Field{"velocity", 3, false, true,
          [](const Source& s, const char* name) {
            return s.vector(name, [&](size_t k) { return s.particles[k].velocity; });
          }},
    Field{"angular_velocity", 3, false, true,
          [](const Source& s, const char* name) {
            return s.vector(name, [&](size_t k) { return s.particles[k].spin; });
          }},
    Field{"force", 3, true, true,
          [](const Source& s, const char* name) {
            return s.vector(name, [&](size_t k) {
              return s.contacts_known ? s.sums.force[k] : Vec3{kUnknown, kUnknown, kUnknown};
            });
          }},
    Field{"coordination", 1, true, true,
          [](const Source& s, const char* name) {
            return s.count(name, [&](size_t k) { return s.sums.coordination[k]; });
          }},
    Field{"wall_contacts", 1, true, true,
          [](const Source& s, const char* name) {
            return s.count(name, [&](size_t k) { return s.sums.wall_contacts[k]; });
          }},
    Field{"contact_stress", 6, true, true,
          [](const Source& s, const char* name) {
            return column<float>(name, 6, s.particles.size(), [&](size_t k, uint64_t i) {
              return s.contacts_known ? s.sums.stress[k][i] : kUnknown;
            });
          }},
    Field{"age", 1, false, true,
          [](const Source& s, const char* name) {
            return column<float>(name, 0, s.particles.size(),
                                 [&](size_t k, uint64_t) { return s.age(s.particles[k].id); });
          }},
    Field{"mass", 1, false, false,
          [](const Source& s, const char* name) {
            return column<float>(name, 0, s.particles.size(), [&](size_t k, uint64_t) { return s.particles[k].mass; });
          }},
};

Column points(const Case& c, const std::vector<ParticleState>& particles) {
  double reach = 0;  // m, of a coordinate
  for (const Vec3& corner : {c.domain.min, c.domain.max})
    for (const double x : {corner.x, corner.y, corner.z}) reach = std::max(reach, std::abs(x));
  const auto get = [&](size_t k, uint64_t i) { return component(particles[k].position, i); };
  if (reach * 0x1p-24 > kMostRounding * smallest_radius(c)) return column<double>("Points", 3, particles.size(), get);
  return column<float>("Points", 3, particles.size(), get);
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
  Source s{engine.particles(), engine.knows_contacts(), {}, engine.time(), engine.dt(), engine.insertions()};
  if (s.contacts_known && std::ranges::any_of(kFields, [&](const Field& f) { return f.from_contacts && wanted(f); }))
    s.sums = contact_sums(s.particles, engine);
  const size_t n = s.particles.size();
  columns_.push_back(points(c, s.particles));
  columns_.push_back(column<uint32_t>("id", 0, n, [&](size_t k, uint64_t) { return s.particles[k].id; }));
  columns_.push_back(column<float>("radius", 0, n, [&](size_t k, uint64_t) { return s.particles[k].radius; }));
  columns_.push_back(column<uint8_t>("kind", 0, n, [&](size_t k, uint64_t) { return s.particles[k].kind; }));
  for (const Field& field : kFields)
    if (wanted(field)) columns_.push_back(field.make(s, field.name));
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
