// Markers of one moment, for RViz and Foxglove: what the message before showed is removed.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core_stack/common/geometry.h"
#include "sdk/mcap_export/ros_messages.h"

namespace karst::mcap {

struct Colour {
  float r = 1, g = 1, b = 1, a = 1;
};
constexpr Colour kOffered{0.20f, 0.60f, 0.90f, 0.6f}, kAccepted{0.95f, 0.70f, 0.10f, 1},
    kReached{0.20f, 0.75f, 0.30f, 1}, kPassed{0.60f, 0.60f, 0.60f, 1}, kFailed{0.85f, 0.20f, 0.20f, 1},
    kText{1, 1, 1, 1};
/// 0xRRGGBB.
constexpr Colour colour_of_rgb(std::uint32_t rgb) {
  const auto channel = [rgb](int shift) { return static_cast<float>((rgb >> shift) & 0xff) / 255.0f; };
  return {channel(16), channel(8), channel(0), 1};
}

class Markers {
 public:
  /// Positions are in the header's frame, metres.
  explicit Markers(ros::Header header);

  /// Within a `group`, an id names one marker.
  void sphere(const char* group, std::uint32_t id, const core::Vec3& at, double diameter_m,
              const Colour& colour);
  void arrow(const char* group, std::uint32_t id, const core::Pose& from, double length_m,
             const Colour& colour);
  void text(const char* group, std::uint32_t id, const core::Vec3& at, const std::string& text,
            const Colour& colour);
  void points(const char* group, std::uint32_t id, std::span<const core::Vec3> points, const Colour& colour);
  /// Pairs of points; a last one without partner is left out.
  void lines(const char* group, std::uint32_t id, std::span<const core::Vec3> points, const Colour& colour);

  ros::MarkerArray take() { return std::move(array_); }

 private:
  ros::Marker& add(const char* group, std::uint32_t id, std::int32_t type, const Colour& colour);

  ros::Header header_;
  ros::MarkerArray array_;
};

}  // namespace karst::mcap
