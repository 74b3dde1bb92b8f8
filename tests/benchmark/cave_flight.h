// Flights through a cave without a control loop: a smooth way to far places and back, what an IMU on it
// measures, and the LiDAR's sweeps. True poses are known, so an estimate can be judged.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "core_stack/common/so3.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/sensors/imu.h"
#include "plugins/simulator/sensors/pose_track.h"

namespace karst::bench {

using core::Pose;
using core::Vec3;

/// Places 0.5 m apart that are at least `clearance_m` from rock, as far as they hang together.
class ClearGrid {
 public:
  ClearGrid(const cave::RayScene& scene, const Vec3& origin, double clearance_m)
      : scene_(scene), origin_(origin), clearance_m_(clearance_m) {}

  /// A way of at least `length_m` from the origin's cell: to the place farthest away, from there to the place
  /// that is farthest of those not yet near the way, and so on.
  std::vector<Vec3> tour(double length_m) {
    std::vector<Vec3> route{origin_};
    Key from{0, 0, 0};
    double length = 0;
    for (int leg = 0; length < length_m && leg < 30; ++leg) {
      search(from, length_m - length + 5);
      Key farthest = from;
      double most = 0;
      for (const auto& [k, node] : nodes_)
        if (node.done && node.distance > most && !near(route, place(k), 15.0))
          most = node.distance, farthest = k;
      if (farthest == from) {  // everything was near the way already: back to the origin, or anywhere far
        for (const auto& [k, node] : nodes_)
          if (node.done && node.distance > most) most = node.distance, farthest = k;
        if (farthest == from) break;
      }
      std::vector<Vec3> back;
      for (Key k = farthest; k != from; k = nodes_[k].from) back.push_back(place(k));
      for (std::size_t i = 1; i < back.size(); ++i) length += (back[i] - back[i - 1]).norm();
      route.insert(route.end(), back.rbegin(), back.rend());
      from = farthest;
    }
    return route;
  }

 private:
  using Key = std::tuple<int, int, int>;
  struct Node {
    double cost = std::numeric_limits<double>::infinity(), distance = 0;
    Key from;
    bool done = false;
  };
  static constexpr double kStep = 0.5;
  Vec3 place(const Key& k) const {
    return origin_ + kStep * Vec3(std::get<0>(k), std::get<1>(k), std::get<2>(k));
  }
  static bool near(const std::vector<Vec3>& route, const Vec3& p, double within) {
    return std::any_of(route.begin(), route.end(), [&](const Vec3& w) { return (w - p).norm() < within; });
  }
  double clearance(const Key& k) {
    const auto [at, made] = clearances_.try_emplace(k, 0);
    if (made) at->second = scene_.distance_to_rock(place(k), 3.0);
    return at->second;
  }
  void search(const Key& start, double max_distance) {
    nodes_.clear();
    std::priority_queue<std::pair<double, Key>, std::vector<std::pair<double, Key>>, std::greater<>> open;
    nodes_[start].cost = 0;
    open.emplace(0.0, start);
    while (!open.empty()) {
      const Key k = open.top().second;
      open.pop();
      Node& node = nodes_[k];
      if (node.done) continue;
      node.done = true;
      if (node.distance > max_distance) continue;
      const double cost = node.cost, distance = node.distance;
      for (int i = 0; i < 27; ++i) {
        const int dx = i % 3 - 1, dy = i / 3 % 3 - 1, dz = i / 9 - 1;
        if (i == 13) continue;
        const Key next{std::get<0>(k) + dx, std::get<1>(k) + dy, std::get<2>(k) + dz};
        const double clear = clearance(next);
        if (clear < clearance_m_) continue;
        const double step = kStep * std::sqrt(dx * dx + dy * dy + dz * dz);
        const double next_cost = cost + step * (1 + 2 * (3.0 - clear) / 3.0 + 1.0 * (dz != 0));
        Node& n = nodes_[next];
        if (next_cost >= n.cost) continue;
        n.cost = next_cost, n.distance = distance + step, n.from = k;
        open.emplace(next_cost, next);
      }
    }
  }

  const cave::RayScene& scene_;
  Vec3 origin_;
  double clearance_m_;
  std::map<Key, double> clearances_;
  std::map<Key, Node> nodes_;
};

/// Poses and IMU samples at 200 Hz along a way: a cubic B-spline through points `speed_mps` apart, flown at
/// one point a second after a few seconds of standing, tilted as a multirotor tilts, shaken by gusts.
struct Flight {
  sim::PoseTrack truth;
  std::vector<core::ImuSample> imu;
  double length_m = 0;
};

inline std::vector<Vec3> resampled(const std::vector<Vec3>& route, double step) {
  std::vector<Vec3> out{route.front()};
  double left = step;
  for (std::size_t i = 1; i < route.size(); ++i) {
    Vec3 a = route[i - 1];
    double d = (route[i] - a).norm();
    while (d >= left) {
      a += (route[i] - a) * (left / d);
      out.push_back(a), d = (route[i] - a).norm(), left = step;
    }
    left -= d;
  }
  return out;
}

/// From 0 to 1 for u from 0 to 1, with two derivatives that are continuous.
inline double gently(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 + u * (6 * u - 15));
}

inline Flight fly_along(const std::vector<Vec3>& route, double heading_rad, double speed_mps, double still_s,
                        const sim::ImuOptions& imu_options, std::uint64_t seed) {
  std::vector<Vec3> points = resampled(route, speed_mps);
  points.insert(points.begin(), 2, points.front());
  points.insert(points.end(), 3, points.back());
  const double flight_s = static_cast<double>(points.size() - 3);
  const auto position = [&](double t) -> Vec3 {
    const double u = std::clamp(t - still_s, 0.0, flight_s - 1e-9);
    const auto i = static_cast<std::size_t>(u);
    const double s = u - static_cast<double>(i);
    const double b0 = (1 - s) * (1 - s) * (1 - s) / 6, b3 = s * s * s / 6;
    const double b1 = (3 * s * s * s - 6 * s * s + 4) / 6, b2 = 1 - b0 - b1 - b3;
    const double sway = gently(t / 3);
    return b0 * points[i] + b1 * points[i + 1] + b2 * points[i + 2] + b3 * points[i + 3] +
           sway * Vec3(0.04 * std::sin(2.5 * t), 0.05 * std::sin(1.9 * t + 1) - 0.05 * std::sin(1.0),
                       0.03 * std::sin(3.1 * t));
  };
  Flight flight;
  constexpr double kStep = 0.005, kG = 9.81;
  double heading = heading_rad;
  core::Random random(seed);
  sim::Imu imu(imu_options, random);
  const auto steps = static_cast<int>((still_s + flight_s) / kStep);
  Pose last;
  for (int n = 0; n <= steps; ++n) {
    const double t = n * kStep, h = 0.01;
    const Vec3 p = position(t);
    const Vec3 a = (position(t + h) - 2 * p + position(std::max(0.0, t - h))) / (h * h);
    const Vec3 ahead = position(t + 1.5) - p;
    if (ahead.head<2>().norm() > 0.7) {
      const double turn = core::wrap_angle(std::atan2(ahead.y(), ahead.x()) - heading);
      heading += std::clamp(1.5 * turn, -0.8, 0.8) * kStep;
    }
    const Vec3 z = (a + kG * Vec3::UnitZ()).normalized();
    const Vec3 y = z.cross(Vec3(std::cos(heading), std::sin(heading), 0)).normalized();
    Eigen::Matrix3d R;
    R << y.cross(z), y, z;
    const double gust = 0.015 * gently(t / 3);
    const Vec3 shake =
        gust * Vec3(std::sin(9 * t), std::sin(7.3 * t + 2) - std::sin(2.0), 0.5 * std::sin(5 * t));
    const Pose pose{p, (core::Quat(R) * core::exp_so3(shake)).normalized()};
    const auto stamp = core::from_seconds(t);
    if (n > 0) {
      const Vec3 rate = core::log_so3((last.orientation.conjugate() * pose.orientation).normalized()) / kStep;
      const double m = t - kStep / 2;  // the middle of the interval
      const Vec3 acceleration =
          (position(m + h) - 2 * position(m) + position(std::max(0.0, m - h))) / (h * h);
      const core::Quat middle = last.orientation.slerp(0.5, pose.orientation);
      flight.imu.push_back(
          imu.sample(stamp, middle.conjugate() * (acceleration + kG * Vec3::UnitZ()), rate, kStep));
      flight.length_m += (pose.position - last.position).norm();
    }
    flight.truth.push_back({stamp, pose});
    last = pose;
  }
  return flight;
}

}  // namespace karst::bench
