// Random numbers that are the same on every machine: a splitmix64 stream, and the few distributions that cases need.
// (The standard library's distributions differ between implementations.)
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace scree {

class Random {
 public:
  // Streams of different numbers are independent for one seed.
  Random(uint64_t seed, uint64_t stream) : state_(seed * 0x9e3779b97f4a7c15ull + stream * 0xd1342543de82ef95ull + 1) {
    bits(), bits();
  }
  uint64_t bits() {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal() {  // Box and Muller, one of the two
    const double u = 1 - uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * uniform());
  }

  template <class Visit>
  static void for_each_field(const Visit& visit) {
    visit("state", &Random::state_);
  }

 private:
  uint64_t state_;
};

}  // namespace scree
