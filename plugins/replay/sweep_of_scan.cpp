#include "plugins/replay/sweep_of_scan.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core_stack/common/error.h"
#include "plugins/replay/rings.h"
#include "plugins/replay/scan_files/decimal_time.h"

namespace karst::replay {
namespace {

using core::InputError;
using core::TimeNs;

/// Sets times in seconds since the start of the sweep, from the angle turned since the first point.
void times_by_azimuth(const RecordingInfo& info, Scan& scan) {
  const double sign = info.time_direction == TurnDirection::clockwise ? -1 : 1;
  const auto azimuth = [](const ScanPoint& p) { return std::atan2(p.position.y(), p.position.x()); };
  const double first = scan.points.empty() ? 0 : azimuth(scan.points.front());
  for (ScanPoint& p : scan.points) {
    const double turned = core::wrap_angle(sign * (azimuth(p) - first) - std::numbers::pi) + std::numbers::pi;
    p.time = info.period_s * turned / (2 * std::numbers::pi);
  }
  scan.has_time = true;
}

/// Converts times to seconds relative to the end of the sweep (<= 0); returns the stamp of the end.
TimeNs assign_times(const RecordingInfo& info, TimeNs stamp, const ScanPlace& place, bool by_azimuth,
                    Scan& scan) {
  const bool known = scan.has_time && !info.compensated && !scan.points.empty();
  if (!known) {
    for (ScanPoint& p : scan.points) p.time = 0;
    return stamp;
  }
  const std::string unit = by_azimuth                 ? "s"
                           : info.time_unit != "auto" ? info.time_unit
                           : scan.time_is_whole       ? "ns"
                                                      : "s";
  const double unit_s = static_cast<double>(nanoseconds_of(unit)) * 1e-9;
  const auto [least, greatest] = std::minmax_element(
      scan.points.begin(), scan.points.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  const double last = greatest->time, length_s = (last - least->time) * unit_s;
  if (length_s > 10)
    throw InputError(
        place.file, place.place,
        "its points' times spread over " + std::to_string(length_s) + " s: time.unit or the field is wrong");
  const TimeOrigin of = by_azimuth ? TimeOrigin::start : info.time_of;
  TimeNs end = stamp;
  if (of == TimeOrigin::absolute) {
    const double end_ns = last * unit_s * 1e9;
    if (std::abs(end_ns) >= 9.2e18)
      throw InputError(place.file, place.place,
                       "its points' times lie beyond the year 2262: time.unit is wrong");
    end = static_cast<TimeNs>(std::llround(end_ns));
  } else if (info.stamp_of == StampMoment::start) {
    end += core::from_seconds(of == TimeOrigin::start ? last * unit_s : length_s);
  }
  // With the stamp at the end, times from the start say by how much each point is before the last.
  for (ScanPoint& p : scan.points) p.time = (p.time - last) * unit_s;
  return end;
}

void order_points(bool has_rings, Scan& scan) {
  const bool by_time =
      std::any_of(scan.points.begin(), scan.points.end(), [](const auto& p) { return p.time != 0; });
  struct Key {
    std::uint16_t ring;
    double within;
    std::uint32_t index;
  };
  std::vector<Key> keys;
  keys.reserve(scan.points.size());
  for (std::uint32_t i = 0; i < scan.points.size(); ++i) {
    const ScanPoint& p = scan.points[i];
    keys.push_back({p.ring,
                    by_time     ? p.time
                    : has_rings ? std::atan2(p.position.y(), p.position.x())
                                : 0,
                    i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.ring, a.within, a.index) < std::tie(b.ring, b.within, b.index);
  });
  std::vector<ScanPoint> sorted;
  sorted.reserve(keys.size());
  for (const Key& k : keys) sorted.push_back(scan.points[k.index]);
  scan.points = std::move(sorted);
}

}  // namespace

core::Sweep sweep_of(Scan scan, TimeNs stamp, const ScanPlace& place, const RecordingInfo& info,
                     const RecordingLayout& layout, ReadNotes* notes) {
  const std::size_t declared = scan.points.size() + scan.dropped;
  const bool by_azimuth = !scan.has_time && !info.compensated && info.time_direction != TurnDirection::none;
  if (by_azimuth) times_by_azimuth(info, scan);
  if (info.rings_by == RingSource::field && !scan.has_ring)
    throw InputError(place.file, place.place, "has no field with rings, which rings.by asks for");
  if (info.rings_by == RingSource::order) {
    rings_by_order(scan);  // before any points are dropped
  }
  std::erase_if(scan.points, [&](const ScanPoint& p) {
    const double range = p.position.norm();
    return range < info.min_range_m || range > info.max_range_m || range == 0;
  });
  if (info.rings_by == RingSource::elevation || (info.rings_by == RingSource::automatic && !scan.has_ring)) {
    if (info.rings == 0)
      throw InputError(
          place.file, place.place,
          "has no field with rings: say in recording.info how many rings the sensor has "
          "(rings.count, rings.lowest, rings.highest), or that they follow each other (rings.by order)");
    rings_by_elevation(scan, info);
  }
  if (notes) {
    notes->dropped = declared - scan.points.size();
    notes->without_times = !scan.has_time && !info.compensated;
  }

  core::Sweep sweep;
  if (info.rings_by == RingSource::none) {
    for (ScanPoint& p : scan.points) p.ring = 0;
    sweep.has_rings = false;
  }
  sweep.T_body_lidar = layout.T_body_lidar;
  sweep.compensated = info.compensated;
  sweep.stamp = assign_times(info, stamp, place, by_azimuth, scan);
  order_points(sweep.has_rings, scan);
  sweep.points.reserve(scan.points.size());
  for (const ScanPoint& p : scan.points)
    sweep.points.push_back({p.position, static_cast<float>(p.time), p.ring, p.intensity});
  return sweep;
}

}  // namespace karst::replay
