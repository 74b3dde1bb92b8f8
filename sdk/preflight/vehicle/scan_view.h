// What the LiDAR sees around a vehicle that stands on its pad: whether it is blocked or dirty, and the room
// around and above.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sdk/preflight/vehicle/vehicle_record.h"

namespace karst::preflight {

constexpr int kSectors = 72;  // of 5 degrees each, counter-clockwise from the body's x axis

struct BlockedArc {
  double from_rad = 0, width_rad = 0;  // azimuth in the body frame; width 0: none
  bool hull = false;                   // most of it are returns on the vehicle's own hull
};

struct LidarView {
  int scans = 0;
  int misshapen = 0;                     // scans whose arrays do not fit their model
  std::array<double, kSectors> clear{};  // fraction of beams that return from outside of the hull
  BlockedArc blocked;                    // the widest run of sectors in which nearly none do
  // Of a LiDAR with rings, whose beams repeat from scan to scan; 0 of others.
  double noise_m = 0;    // standard deviation of a beam's range: median of the beams
  double flicker = 0;    // fraction of beams that return in some scans and not in others
  double intensity = 0;  // median
};
LidarView lidar_view(std::span<const std::shared_ptr<const core::LidarScan>> scans, double hull_radius_m);

struct PlanPoint {
  float x = 0, y = 0, z = 0;  // m, from the vehicle's centre; x forward, z up against gravity
};

struct PadRoom {
  bool known = false;       // there were returns
  double above_m = 0;       // free height above the vehicle's centre in the column that it climbs in
  bool seen_above = false;  // a sensor looks into that column at the height of the climb
  double around_m = 0;      // free distance from the hull, at the heights of the climb
  double above_looked_m = 0, around_looked_m = 0;  // how far was looked; no more is known
  std::vector<PlanPoint> points;                   // of one scan, thinned, for a drawing
};

/// `up`: measured in the body frame, of any length. `climb_m`: by which it will rise.
PadRoom pad_room(const VehicleRecord& record, const core::Vec3& up, double climb_m);

}  // namespace karst::preflight
