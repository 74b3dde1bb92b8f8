// A seeded random stream that gives the same numbers on every platform (the standard library's
// distributions do not promise that). Generator: SplitMix64 (Steele, Lea, Flood, 2014).
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace karst::core {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// An independent stream for each named purpose of one mission seed.
  static Random stream(std::uint64_t seed, std::string_view purpose) {
    std::uint64_t h = 0xcbf29ce484222325ull ^ seed;  // FNV-1a over the name
    for (const char c : purpose) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    Random r(h ^ (seed * 0x9e3779b97f4a7c15ull));
    r.bits();
    return r;
  }

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box-Muller).
  double normal() {
    const double u = 1.0 - uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace karst::core
