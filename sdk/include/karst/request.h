// One request: the state of the vehicle, the map and frontiers, and the services of the host. World frame.
#pragma once
#include <string>
#include <vector>

#include <karst/chunks.h>
#include <karst/map_view.h>
#include <karst/types.h>

namespace karst {

class Request {
 public:
  Request(const karst_host_t* host, const karst_request_t& r)
      : sequence(r.sequence),
        stamp_ns(r.stamp_ns),
        deadline_ns(r.deadline_ns),
        state(r.state),
        direction_of_flight(r.direction_of_flight),
        T_world_start(r.T_world_start),
        seconds_before_homing(r.seconds_before_homing),
        max_speed_mps(r.max_speed_mps),
        clearance_m(r.clearance_m),
        vehicle_radius_m(r.vehicle_radius_m),
        last_fate(r.last_fate),
        last_goal(r.last_goal),
        map(host, r.map),
        sensors(r.sensors, r.sensors + r.sensor_count),
        teammates(r.teammates, r.teammates + r.teammate_count),
        battery_fraction(KARST_HAS(karst_request_t, &r, battery_fraction) ? r.battery_fraction : 0),
        battery_seconds_left(KARST_HAS(karst_request_t, &r, battery_seconds_left) ? r.battery_seconds_left
                                                                                  : 0),
        mission_seconds_left(KARST_HAS(karst_request_t, &r, mission_seconds_left) ? r.mission_seconds_left
                                                                                  : 0),
        host_(host) {
    frontiers.reserve(r.frontier_count);
    for (std::uint64_t i = 0; i < r.frontier_count; ++i) frontiers.push_back(from_abi(r.frontiers[i]));
  }

  const std::uint32_t sequence;  // 1, 2, ...
  const std::int64_t stamp_ns, deadline_ns;
  const State state;               // in flight: predicted for deadline_ns
  const Vec3 direction_of_flight;  // unit; along the heading while the vehicle is at rest
  const Pose T_world_start;
  const double seconds_before_homing;
  const double max_speed_mps, clearance_m, vehicle_radius_m;
  const karst_goal_fate_t last_fate;  // KARST_FATE_*
  const Vec3 last_goal;               // meaningless if the fate is KARST_FATE_NONE
  const MapView map;
  std::vector<Frontier> frontiers;  // by id
  const std::vector<Sensor> sensors;
  const std::vector<Teammate> teammates;
  // 0: not told.
  const double battery_fraction;      // share of the battery's energy that is left, (0, 1]
  const double battery_seconds_left;  // until the battery is empty, at the recent mean power
  const double mission_seconds_left;  // of the mission's maximum flight time; +infinity: it has none

  Vec3 position() const { return state.position; }

  /// Length of a clear path to each goal in metres, +infinity where none is known; one search for all goals,
  /// if there are no more than KARST_MAX_PATH_GOALS.
  std::vector<double> path_lengths(const Vec3& from, const std::vector<Vec3>& goals,
                                   double tolerance_m) const {
    std::vector<double> out(goals.size());
    const karst_path_service_t& path = offered(host_->path, "paths");
    for_chunks(goals.size(), KARST_MAX_PATH_GOALS, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(path.lengths(host_, from, goals.data() + begin, size, tolerance_m, out.data() + begin, &e), e);
    });
    return out;
  }

  /// A path to each goal with its points, clearance and flight time. One search for each goal: ask for the
  /// few that matter. Throws Error with KARST_ERROR_LIMIT if so many cannot be searched in a map so large.
  std::vector<Path> paths(const Vec3& from, const std::vector<Vec3>& goals, double tolerance_m = 0.5) const {
    const karst_path_service_t& path = offered(host_->path, "paths");
    if (!KARST_HAS(karst_path_service_t, &path, paths))
      throw Error("this host offers no points of paths", KARST_ERROR_UNAVAILABLE);
    std::vector<Path> out;
    out.reserve(goals.size());
    for_chunks(goals.size(), KARST_MAX_PATHS, [&](std::size_t begin, std::size_t size) {
      add_paths(path, from, goals.data() + begin, size, tolerance_m, out);
    });
    return out;
  }

  /// Number of unknown cells that `sensor` would see, one for each viewpoint. A shorter range costs less.
  std::vector<std::uint64_t> newly_seen(const Sensor& sensor, const std::vector<Viewpoint>& from) const {
    std::vector<std::uint64_t> out(from.size());
    const karst_gain_service_t& gain = offered(host_->gain, "gains");
    for_chunks(from.size(), KARST_MAX_GAIN_VIEWPOINTS, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(
          gain.newly_seen(host_, map.handle(), &sensor, 1, from.data() + begin, size, out.data() + begin, &e),
          e);
    });
    return out;
  }

  void draw_points(const std::vector<Vec3>& points, std::uint32_t rgb) const {
    karst_error_t e{};
    check(offered(host_->draw, "drawings").points(host_, points.data(), points.size(), rgb, &e), e);
  }
  void draw_lines(const std::vector<karst_segment_t>& lines, std::uint32_t rgb) const {
    karst_error_t e{};
    check(offered(host_->draw, "drawings").lines(host_, lines.data(), lines.size(), rgb, &e), e);
  }
  void draw_text(const Vec3& at, const std::string& text, std::uint32_t rgb) const {
    karst_error_t e{};
    check(offered(host_->draw, "drawings").text(host_, at, to_abi(text), rgb, &e), e);
  }

  void log(const std::string& line) const { host_->log(host_, KARST_LOG_INFO, to_abi(line)); }
  /// Uniform in [0, 1), the same in every replay with the mission's seed.
  double random() const {
    double v = 0;
    host_->random(host_, &v, 1);
    return v;
  }
  /// For extensions: see karst/imaged.h.
  const karst_host_t* host() const { return host_; }
  /// True once the host no longer waits: long loops should call it regularly, and return.
  bool should_stop() const { return host_->should_stop(host_) != 0; }

 private:
  /// A service that this host does not offer is an error, not a crash.
  template <class Service>
  static const Service& offered(const Service* service, const char* what) {
    if (service == nullptr) throw Error(std::string("this host offers no ") + what, KARST_ERROR_UNAVAILABLE);
    return *service;
  }

  /// To as many goals as one call takes.
  void add_paths(const karst_path_service_t& path, const Vec3& from, const Vec3* goals, std::size_t count,
                 double tolerance_m, std::vector<Path>& out) const {
    std::vector<karst_path_t> found(count);
    std::vector<Vec3> points(256 * count);
    const auto ask = [&] {
      karst_error_t e{};
      check(
          path.paths(host_, from, goals, count, tolerance_m, found.data(), points.data(), points.size(), &e),
          e);
      const std::uint64_t total = found.empty() ? 0 : found.back().points_end;
      const bool all = total <= points.size();
      points.resize(total);
      return all;
    };
    if (!ask()) ask();
    std::uint64_t begin = 0;
    for (const karst_path_t& f : found) {
      out.push_back({{points.begin() + static_cast<std::ptrdiff_t>(begin),
                      points.begin() + static_cast<std::ptrdiff_t>(f.points_end)},
                     f.length_m,
                     f.clearance_m,
                     f.time_s});
      begin = f.points_end;
    }
  }

  const karst_host_t* host_;
};

}  // namespace karst
