#include "sdk/preflight/vehicle/vehicle_plots.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core_stack/common/format_text.h"
#include "core_stack/common/xml_text.h"

namespace karst::preflight {
namespace {

using core::format_text;

struct Curve {
  std::string name, style;  // attributes of its line
  std::vector<std::pair<double, double>> points;
};

/// A box 70 mm wide with curves over time, and their names below, two in a row.
class Plot {
 public:
  Plot(double end_s, double top, std::string y_title) : end_s_(std::max(end_s, 1e-3)), top_(top) {
    body_ = format_text("<path class=\"frame\" d=\"M%g %gh%gv%gh%gz\"/>\n", kLeft, kTop, kWidth, kHeight,
                        -kWidth);
    body_ +=
        format_text("<text x=\"%g\" y=\"%g\">", kLeft, kTop - 1.5) + core::xml_text(y_title) + "</text>\n";
    for (int i = 0; i <= 2; ++i)
      body_ += format_text("<text x=\"%g\" y=\"%g\" text-anchor=\"end\">%.3g</text>\n", kLeft - 1,
                           y_of(top_ * i / 2) + 1, top_ * i / 2);
    for (int i = 0; i <= 4; ++i)
      body_ += format_text("<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">%.3g</text>\n",
                           x_of(end_s_ * i / 4), kTop + kHeight + 3.5, end_s_ * i / 4);
    body_ += format_text("<text x=\"%g\" y=\"%g\" text-anchor=\"end\">s</text>\n", kLeft + kWidth + 4,
                         kTop + kHeight + 3.5);
  }
  void add(const Curve& curve) {
    std::string d;
    for (const auto& [x, y] : curve.points)
      d += format_text("%c%.2f %.2f", d.empty() ? 'M' : 'L', x_of(x), y_of(std::clamp(y, 0.0, top_)));
    const double x = kLeft + kNameWidth * (curves_ % kNamesInARow),
                 y = kTop + kHeight + 8 + 4.0 * (curves_ / kNamesInARow);
    ++curves_;
    body_ += "<path " + curve.style + " d=\"" + d + "\"/>\n" +
             format_text("<path %s d=\"M%g %gh5\"/>\n", curve.style.c_str(), x, y - 1) +
             format_text("<text x=\"%g\" y=\"%g\">", x + 6, y) + core::xml_text(curve.name) + "</text>\n";
  }
  void mark(double x) {
    body_ += format_text("<path class=\"frame\" stroke-dasharray=\"1 1\" d=\"M%.2f %gv%g\"/>\n", x_of(x),
                         kTop, kHeight);
  }
  std::string svg(const char* label) const {
    return format_text(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" role=\"img\" aria-label=\"%s\" "
               "viewBox=\"0 0 70 %g\">\n",
               label, kTop + kHeight + 6 + 4.0 * ((curves_ + kNamesInARow - 1) / kNamesInARow)) +
           body_ + "</svg>\n";
  }

 private:
  static constexpr double kLeft = 9, kTop = 6, kWidth = 56, kHeight = 24, kNameWidth = 30;
  static constexpr int kNamesInARow = 2;
  double x_of(double s) const { return kLeft + kWidth * s / end_s_; }
  double y_of(double v) const { return kTop + kHeight * (1 - v / top_); }

  double end_s_, top_;
  int curves_ = 0;
  std::string body_;
};

/// Lines that a printer without colours tells apart.
std::string style_of(std::size_t i) {
  constexpr const char* kStyles[] = {
      "class=\"curve\" stroke=\"#111\"", "class=\"curve\" stroke=\"#111\" stroke-dasharray=\"2 1\"",
      "class=\"curve\" stroke=\"#888\"", "class=\"curve\" stroke=\"#888\" stroke-dasharray=\"2 1\"",
      "class=\"curve\" stroke=\"#111\" stroke-dasharray=\"0.5 0.8\""};
  return kStyles[i % std::size(kStyles)];
}

/// Behind another one that should lie on it.
constexpr const char* kBehind = "class=\"curve wide\" stroke=\"#bbb\"";

/// Those of which a flight needs every message.
bool is_drawn(Sensor sensor) {
  return sensor == Sensor::imu || sensor == Sensor::lidar || sensor == Sensor::camera ||
         sensor == Sensor::pose;
}

}  // namespace

std::string rates_svg(const VehicleMeasurements& m) {
  constexpr double kTop = 150;  // %
  Plot plot(m.rest_s + m.motion_s, kTop, "messages in a second, % of what is required");
  std::size_t i = 0;
  for (const SensorTimeline& s : m.sensors) {
    if (s.timeline.messages == 0 || !is_drawn(s.sensor)) continue;
    Curve curve{s.name.empty() ? core::name_of(s.sensor) : "camera " + s.name, style_of(i++), {}};
    for (std::size_t k = 0; k < s.timeline.per_second.size(); ++k)
      curve.points.emplace_back(static_cast<double>(k) + 0.5, 100 * s.timeline.per_second[k] / s.required_hz);
    plot.add(curve);
  }
  if (i == 0) return "";
  if (m.motion) plot.mark(m.rest_s);
  return plot.svg("Rates of the sensors over time");
}

std::string turns_svg(const VehicleMeasurements& m) {
  if (!m.motion || m.motion->gyroscope_rates.empty()) return "";
  const core::TimeNs begin = m.motion->gyroscope_rates.front().stamp;
  constexpr double kDegree = std::numbers::pi / 180;
  double top = 10;
  const auto curve_of = [&](const char* name, const std::string& style, const std::vector<TurnRate>& rates) {
    Curve curve{name, style, {}};
    for (const TurnRate& r : rates) {
      if (r.stamp < begin) continue;
      curve.points.emplace_back(core::seconds(r.stamp - begin), r.radps / kDegree);
      top = std::max(top, r.radps / kDegree);
    }
    return curve;
  };
  const Curve gyroscope = curve_of("gyroscope", kBehind, m.motion->gyroscope_rates),
              lidar = curve_of("LiDAR", style_of(0), m.motion->lidar_rates);
  Plot plot(m.motion_s, 20 * std::ceil(std::min(top, 400.0) / 20), "rate of rotation, deg/s");
  plot.add(gyroscope);
  plot.add(lidar);
  return plot.svg("Rates of rotation by LiDAR and gyroscope");
}

std::string pad_svg(const VehicleMeasurements& m) {
  if (m.room.points.empty()) return "";
  constexpr double kReach_m = 4;
  std::string floor, walls;
  for (const PlanPoint& p : m.room.points) {
    if (std::abs(p.x) > kReach_m || std::abs(p.y) > kReach_m) continue;
    const bool beside = p.z > 0 && p.z < m.climb_m + m.vehicle.radius_m;
    (beside ? walls : floor) +=
        format_text("M%.2f %.2fh.01", -static_cast<double>(p.y), -static_cast<double>(p.x));
  }
  return format_text(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"pad\" role=\"img\" aria-label=\"A scan "
             "around the "
             "pad, from above\" viewBox=\"%g %g %g %g\">\n",
             -kReach_m, -kReach_m, 2 * kReach_m, 2 * kReach_m) +
         "<path class=\"floor\" d=\"" + floor + "\"/>\n<path class=\"walls\" d=\"" + walls + "\"/>\n" +
         format_text("<circle class=\"hull\" r=\"%.2f\"/><circle class=\"room\" r=\"%.2f\"/>\n",
                     m.vehicle.radius_m, m.vehicle.radius_m + 0.3) +
         format_text("<path class=\"hull\" d=\"M0 0V%.2f\"/>\n", -m.vehicle.radius_m) +
         format_text(
             "<path class=\"bar\" d=\"M%g %gh1\"/><text x=\"%g\" y=\"%g\" font-size=\"0.3\">1 "
             "m</text>\n</svg>\n",
             -kReach_m + 0.2, kReach_m - 0.2, -kReach_m + 0.2, kReach_m - 0.3);
}

}  // namespace karst::preflight
