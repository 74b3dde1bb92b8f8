#include "sdk/preflight/vehicle/scan_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sdk/preflight/vehicle/median.h"

namespace karst::preflight {
namespace {

using core::LidarModel;
using core::LidarScan;
using core::Pose;
using core::Quat;
using core::Vec3;

constexpr double kHullMargin_m = 0.05;  // as the core's own filter of returns from the vehicle
constexpr double kBlocked = 0.1;        // fewer clear beams: the sector is blocked
constexpr int kLeastScans = 5;          // for noise
constexpr double kColumnMargin_m = 0.1, kLookAbove_m = 4, kLookAround_m = 3;
constexpr std::size_t kStrayReturns = 5;  // so many nearest returns may be noise

/// Of the vehicle itself: within its hull, or nearer to the sensor than anything outside usually is.
bool is_own(double range_m, const Vec3& p_body, double hull_radius_m) {
  return std::min(range_m, p_body.norm()) < hull_radius_m + kHullMargin_m;
}

/// Of the body frame.
struct Beam {
  Vec3 origin = Vec3::Zero(), direction = Vec3::UnitX();
  Vec3 at(double range_m) const { return origin + range_m * direction; }
};

/// As the scan's ranges. With rings the beams of all scans are the same.
std::vector<Beam> beams_of(const LidarScan& scan) {
  const LidarModel& model = *scan.model;
  const Pose& T = model.T_body_lidar;
  std::vector<Beam> beams;
  beams.reserve(scan.range_m.size());
  for (const core::Vec3f& d : scan.direction) beams.push_back({T.position, T.orientation * d.cast<double>()});
  if (!model.has_rings()) return beams;
  beams.clear();
  for (int c = 0; c < model.channels(); ++c)
    for (int j = 0; j < model.columns; ++j)
      beams.push_back(
          {T * model.origin(j).cast<double>(), T.orientation * model.direction(c, j).cast<double>()});
  return beams;
}

std::size_t sector_of(const Vec3& direction) {
  const double turn = std::atan2(direction.y(), direction.x()) / (2 * std::numbers::pi);
  return static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * kSectors) % kSectors;
}

/// The widest run of blocked sectors, around the circle.
BlockedArc widest_arc(const std::array<double, kSectors>& clear, const std::array<double, kSectors>& hull) {
  int best_from = 0, best = 0;
  for (int from = 0; from < kSectors; ++from) {
    int run = 0;
    while (run < kSectors && clear[static_cast<std::size_t>((from + run) % kSectors)] < kBlocked) ++run;
    if (run > best) {
      best = run;
      best_from = from;
    }
  }
  constexpr double kSector_rad = 2 * std::numbers::pi / kSectors;
  double hull_sum = 0;
  for (int i = 0; i < best; ++i) hull_sum += hull[static_cast<std::size_t>((best_from + i) % kSectors)];
  return {best_from * kSector_rad, best * kSector_rad, best > 0 && hull_sum > 0.5 * best};
}

struct BeamStatistics {
  int returns = 0;
  double sum_m = 0, squares_m2 = 0;

  void add(double range_m) {
    ++returns;
    sum_m += range_m;
    squares_m2 += range_m * range_m;
  }
};

/// The k-th least of the values, or `most` if there are fewer.
double least_but(std::vector<double> values, std::size_t k, double most) {
  if (values.size() <= k) return most;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return std::min(most, values[k]);
}

/// The heights and distances of returns near the vehicle.
class Surroundings {
 public:
  Surroundings(const VehicleRecord& record, const Vec3& up, double climb_m)
      : q_level_body_(Quat::FromTwoVectors(up.norm() > 0 ? up : Vec3::UnitZ(), Vec3::UnitZ())),
        radius_m_(record.vehicle.radius_m),
        climb_m_(climb_m) {}

  Vec3 level(const Vec3& p_body) const { return q_level_body_ * p_body; }
  void add(const Vec3& origin_body, const Vec3& ray_m) {
    const Vec3 p_body = origin_body + ray_m;
    if (is_own(ray_m.norm(), p_body, radius_m_)) return;
    any_ = true;
    const Vec3 p = level(p_body);
    const double aside_m = p.head<2>().norm();
    if (aside_m < radius_m_ + kColumnMargin_m && p.z() > 0) above_m_.push_back(p.z());
    if (p.z() > 0 && p.z() < climb_m_ + radius_m_) around_m_.push_back(aside_m - radius_m_);
  }
  /// Whether a ray from `origin` passes through the column at the height of the climb.
  bool in_column(const Vec3& origin_body, const Vec3& direction_body) const {
    const Vec3 from = level(origin_body), d = level(direction_body);
    const double height_m = climb_m_ + radius_m_;
    if (d.z() <= 0 || from.z() >= height_m) return false;
    const Vec3 p = from + (height_m - from.z()) / d.z() * d;
    return p.head<2>().norm() < radius_m_ + kColumnMargin_m;
  }
  void write(PadRoom& room) const {
    room.known = any_;
    room.above_m = least_but(above_m_, kStrayReturns, kLookAbove_m);
    room.around_m = std::max(0.0, least_but(around_m_, kStrayReturns, kLookAround_m));
    room.above_looked_m = kLookAbove_m;
    room.around_looked_m = kLookAround_m;
  }

 private:
  Quat q_level_body_;
  double radius_m_, climb_m_;
  bool any_ = false;
  std::vector<double> above_m_, around_m_;
};

void add_scan(const LidarScan& scan, Surroundings& around, PadRoom& room, bool draw) {
  constexpr std::size_t kDrawn = 3000;
  const std::vector<Beam> beams = beams_of(scan);
  const std::size_t step = std::max<std::size_t>(1, beams.size() / kDrawn);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto range_m = static_cast<double>(scan.range_m[i]);
    if (!std::isnan(range_m) && !room.seen_above)
      room.seen_above = around.in_column(beams[i].origin, beams[i].direction);
    if (!std::isfinite(range_m) || range_m <= 0) continue;
    around.add(beams[i].origin, range_m * beams[i].direction);
    if (!draw || i % step != 0) continue;
    const Eigen::Vector3f q = around.level(beams[i].at(range_m)).cast<float>();
    room.points.push_back({q.x(), q.y(), q.z()});
  }
}

void add_image(const core::DepthImage& image, Surroundings& around, PadRoom& room) {
  const core::CameraModel& model = *image.model;
  if (image.range_m.size() != static_cast<std::size_t>(model.width) * static_cast<std::size_t>(model.height))
    return;
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column) {
      const auto range_m = static_cast<double>(
          image.range_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(model.width) +
                        static_cast<std::size_t>(column)]);
      const Vec3 beam = model.T_body_camera.orientation * model.direction(row, column).cast<double>();
      if (!std::isnan(range_m) && !room.seen_above)
        room.seen_above = around.in_column(model.T_body_camera.position, beam);
      if (std::isfinite(range_m) && range_m > 0) around.add(model.T_body_camera.position, range_m * beam);
    }
}

}  // namespace

LidarView lidar_view(std::span<const std::shared_ptr<const LidarScan>> scans, double hull_radius_m) {
  LidarView view;
  std::array<double, kSectors> clear{}, hull{}, beams_in{};
  std::vector<double> intensities;
  std::vector<BeamStatistics> statistics;
  std::vector<Beam> beams;
  const bool repeats = !scans.empty() && scans.front()->model && scans.front()->model->has_rings();
  for (const auto& scan : scans) {
    if (!scan->fits_model() || (repeats && view.scans > 0 && scan->range_m.size() != beams.size())) {
      ++view.misshapen;
      continue;
    }
    if (view.scans++ == 0 || !repeats) beams = beams_of(*scan);
    if (repeats) statistics.resize(beams.size());
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const std::size_t sector = sector_of(beams[i].direction);
      ++beams_in[sector];
      const auto range_m = static_cast<double>(scan->range_m[i]);
      if (!std::isfinite(range_m) || range_m <= 0) continue;
      if (is_own(range_m, beams[i].at(range_m), hull_radius_m)) {
        ++hull[sector];
        continue;
      }
      ++clear[sector];
      if (repeats) statistics[i].add(range_m);
      if (i < scan->intensity.size() && std::isfinite(scan->intensity[i]))
        intensities.push_back(static_cast<double>(scan->intensity[i]));
    }
  }
  if (view.scans == 0) return view;
  for (std::size_t s = 0; s < kSectors; ++s) {
    view.clear[s] = beams_in[s] > 0 ? clear[s] / beams_in[s] : 1;
    hull[s] = beams_in[s] > 0 ? hull[s] / beams_in[s] : 0;
  }
  view.blocked = widest_arc(view.clear, hull);
  std::vector<double> noise_m;
  int flickering = 0, returning = 0;
  for (const BeamStatistics& s : statistics) {
    if (s.returns == 0) continue;
    ++returning;
    if (s.returns < 0.9 * view.scans) ++flickering;
    if (s.returns < kLeastScans) continue;
    const double mean_m = s.sum_m / s.returns;
    noise_m.push_back(std::sqrt(std::max(0.0, s.squares_m2 / s.returns - mean_m * mean_m)));
  }
  if (!noise_m.empty()) view.noise_m = median(noise_m);
  view.flicker = returning > 0 ? static_cast<double>(flickering) / returning : 0;
  view.intensity = intensities.empty() ? std::numeric_limits<double>::quiet_NaN() : median(intensities);
  return view;
}

PadRoom pad_room(const VehicleRecord& record, const Vec3& up, double climb_m) {
  constexpr std::size_t kScans = 5;
  PadRoom room;
  Surroundings around(record, up, climb_m);
  for (std::size_t i = 0; i < std::min(kScans, record.scans_at_rest.size()); ++i)
    if (record.scans_at_rest[i]->fits_model())
      add_scan(*record.scans_at_rest[i], around, room, room.points.empty());
  for (const CameraRecord& camera : record.cameras)
    for (const auto& image : camera.images) add_image(*image, around, room);
  around.write(room);
  return room;
}

}  // namespace karst::preflight
