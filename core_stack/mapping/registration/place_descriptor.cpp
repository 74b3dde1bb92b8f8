#include "core_stack/mapping/registration/place_descriptor.h"

#include <algorithm>
#include <complex>

namespace karst::core {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr float kFull = 3;  // points that fill a cell: further ones add no information

}  // namespace

PlaceDescriptor::PlaceDescriptor(const PointTree& points, const PlaceFrame& frame, double cell_m) {
  cells_.setZero();
  invariants_.setZero();
  const double reach = cell_m * std::hypot(kRings, kSlices / 2);
  const Quat to_frame = frame.orientation.conjugate();
  for (const std::uint32_t i : points.within(frame.position, reach)) {
    const Vec3 p = to_frame * (points.points()[i].cast<double>() - frame.position);
    const int ring = static_cast<int>(p.head<2>().norm() / cell_m);
    const int slice = static_cast<int>(std::floor(p.z() / cell_m)) + kSlices / 2;
    if (ring >= kRings || slice < 0 || slice >= kSlices) continue;
    const double turn = std::atan2(p.y(), p.x()) / kTwoPi;
    const int sector = static_cast<int>(std::floor((turn - std::floor(turn)) * kSectors)) % kSectors;
    cells_(ring * kSlices + slice, sector) += 1;
    ++count_;
  }
  cells_ = (cells_ / kFull).cwiseMin(1.0f);
  // The mean of two sectors, so that a point near a sector's border causes no jump.
  const auto once = cells_.eval();
  for (int s = 0; s < kSectors; ++s)
    cells_.col(s) =
        once.col(s) + 0.5f * (once.col((s + 1) % kSectors) + once.col((s + kSectors - 1) % kSectors));
  if (cells_.norm() > 0) cells_ /= cells_.norm();

  for (int row = 0; row < cells_.rows(); ++row)
    for (int h = 0; h < kHarmonics; ++h) {
      std::complex<float> sum = 0;
      for (int s = 0; s < kSectors; ++s)
        sum += cells_(row, s) * std::polar(1.0f, static_cast<float>(kTwoPi * h * s / kSectors));
      invariants_[row * kHarmonics + h] = std::abs(sum);
    }
  if (invariants_.norm() > 0) invariants_.normalize();
}

PlaceDescriptor::Turn PlaceDescriptor::turn_of(const PlaceDescriptor& other) const {
  std::array<float, kSectors> agreement{};
  for (int shift = 0; shift < kSectors; ++shift)
    for (int s = 0; s < kSectors; ++s)
      agreement[static_cast<std::size_t>(shift)] +=
          cells_.col((s + shift) % kSectors).dot(other.cells_.col(s));
  const auto best =
      static_cast<int>(std::max_element(agreement.begin(), agreement.end()) - agreement.begin());
  const auto at = [&](int i) {
    return static_cast<double>(agreement[static_cast<std::size_t>((i + kSectors) % kSectors)]);
  };
  // The vertex of the parabola through the best shift and its neighbours.
  const double bend = at(best - 1) - 2 * at(best) + at(best + 1);
  const double off = bend < 0 ? 0.5 * (at(best - 1) - at(best + 1)) / bend : 0;
  return {wrap_angle((best + std::clamp(off, -0.5, 0.5)) * kTwoPi / kSectors), at(best)};
}

}  // namespace karst::core
