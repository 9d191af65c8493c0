// Refusing an argument with everything the user needs to mend it: name, value, what is allowed, unit.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

namespace scree {

// `allowed` is a range or a condition in words, with its unit: "in (0, inf) m", "above z0 = 0.1 m".
inline void require(bool valid, std::string_view name, double value, std::string_view unit, std::string_view allowed) {
  if (!valid)
    throw std::invalid_argument(fmt::format("{} = {:g} {} is not allowed: it must be {}", name, value, unit, allowed));
}

inline void require_positive(std::string_view name, double value, std::string_view unit = "m") {
  require(value > 0 && std::isfinite(value), name, value, unit, fmt::format("in (0, inf) {}", unit));
}

inline void require_not_negative(std::string_view name, double value, std::string_view unit = "m") {
  require(value >= 0 && std::isfinite(value), name, value, unit, fmt::format("in [0, inf) {}", unit));
}

inline void require_finite(std::string_view name, double value, std::string_view unit = "m") {
  require(std::isfinite(value), name, value, unit, fmt::format("in (-inf, inf) {}", unit));
}

}  // namespace scree
