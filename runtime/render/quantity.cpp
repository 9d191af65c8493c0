#include "runtime/render/quantity.h"

#include <algorithm>

#include "runtime/case_sections.h"
#include "runtime/render/known_name.h"

namespace scree {

namespace {

struct Known {
  const char *field, *quantity, *unit;
};
// Fields whose quantity has another name, or that have a unit. A field that is not here keeps its name, without a unit.
constexpr Known kKnown[] = {{"velocity", "speed", "m/s"},
                            {"angular_velocity", "angular_velocity", "rad/s"},
                            {"force", "force", "N"},
                            {"torque", "torque", "N m"},
                            {"age", "age", "s"},
                            {"contact_stress", "contact_stress", "Pa"},
                            {"stress", "stress", "Pa"},
                            {"pressure", "pressure", "Pa"},
                            {"temperature", "temperature", "K"},
                            {"mass", "mass", "kg"}};
constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr const char* kPairsOfAxes[] = {"xx", "yy", "zz", "xy", "yz", "xz"};  // as files have them
constexpr const char* kPressure = "pressure";
constexpr const char* kCounts[] = {"coordination", "wall_contacts"};  // -1: not known
constexpr double kShown = 0.99;                                       // of the values are within the colour bar

const Known* known_field(const std::string& field) {
  const auto found = std::ranges::find_if(kKnown, [&](const Known& k) { return field == k.field; });
  return found == std::end(kKnown) ? nullptr : found;
}
std::string quantity_name(const std::string& field) {
  const Known* known = known_field(field);
  return known ? known->quantity : field;
}

std::string unit_of(const std::string& quantity) {
  if (quantity == "diameter") return "m";
  for (const Known& k : kKnown)
    if (quantity == k.quantity || quantity.starts_with(std::string(k.field) + "_")) return k.unit;
  return "";
}

// The quantities of a field with how to get them: -1 the length, a tensor's trace / 3 or the value itself, else the
// component. A tensor's own name is another for its pressure.
std::vector<std::pair<std::string, int>> quantities_of(const ParticleField& field) {
  std::vector<std::pair<std::string, int>> names{{quantity_name(field.name), -1}};
  if (field.components == 6) {
    names.emplace_back(kPressure, -1);
    for (int k = 0; k < 6; ++k) names.emplace_back(field.name + "_" + kPairsOfAxes[k], k);
  }
  if (field.components == 3)
    for (int axis = 0; axis < 3; ++axis) names.push_back({field.name + "_" + kAxes[axis], axis});
  return names;
}

double value_of(const ParticleField& field, size_t k, int component) {
  const float* v = &field.values[k * field.components];
  if (component >= 0) return v[component];
  if (field.components == 1) return v[0];
  if (field.components == 6) return (double(v[0]) + v[1] + v[2]) / 3;  // compression is positive
  double sum = 0;
  for (int c = 0; c < field.components; ++c) sum += double(v[c]) * v[c];
  return std::sqrt(sum);
}

double round_up(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double factor : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (x <= factor * power * (1 + 1e-9)) return factor * power;
  return 10 * power;
}

ValueRange range_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return {0, 1};
  const auto [least, most] = std::ranges::minmax(values);
  if (least > 0.5 * most && least < most) return {least, most};
  for (double& v : values) v = std::abs(v);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kShown * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  const double largest = *at > 0 ? *at : std::max(std::abs(least), std::abs(most));
  const double end = largest > 0 ? round_up(largest) : 1;
  return {least < 0 ? -end : 0, end};
}

}  // namespace

std::vector<std::string> quantities_of(const ParticleFrame& frame) {
  std::vector<std::string> names;
  for (const ParticleField& field : frame.fields)
    for (const auto& [name, component] : quantities_of(field)) names.push_back(name);
  names.push_back("diameter");
  return names;
}

const ParticleField* field_of(const ParticleFrame& frame, const std::string& quantity) {
  for (const ParticleField& field : frame.fields)
    for (const auto& [name, component] : quantities_of(field))
      if (name == quantity) return &field;
  return nullptr;
}

std::vector<double> values_of(const ParticleFrame& frame, const std::string& quantity) {
  std::vector<double> values(frame.count());
  if (quantity == "diameter") {
    for (size_t k = 0; k < values.size(); ++k) values[k] = 2 * frame.radii[k];
    return values;
  }
  const ParticleField* field = field_of(frame, quantity);
  if (!field) fail_unknown_name("quantity", quantity, quantities_of(frame));
  for (const auto& [name, component] : quantities_of(*field))
    if (name == quantity)
      for (size_t k = 0; k < values.size(); ++k) values[k] = value_of(*field, k, component);
  if (std::ranges::find(kCounts, field->name) != std::end(kCounts))
    std::ranges::replace_if(
        values, [](double v) { return v < 0; }, std::nan(""));
  return values;
}

ColourScale colour_scale(const Case& c, const std::string& quantity, std::vector<double> values,
                         const std::optional<ValueRange>& given) {
  ColourScale scale;
  scale.quantity = quantity == "contact_stress" ? kPressure : quantity, scale.unit = unit_of(quantity);
  std::ranges::replace(scale.quantity, '_', ' ');
  if (quantity == "kind") {
    scale.categories = names_of(c.kinds);
    return scale;
  }
  const ValueRange range = given ? *given : range_of(std::move(values));
  scale.min = range.min, scale.max = range.max;
  scale.map = range.min < 0 && range.max > 0 ? ColourMap::diverging : ColourMap::sequential;
  return scale;
}

}  // namespace scree
