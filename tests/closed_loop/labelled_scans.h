// Scans of a flight with and without dust in the air: what the dust put in, and what of the rock is left.
#pragma once
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "plugins/simulator/environment/cave_air.h"
#include "plugins/simulator/sensors/lidar.h"

namespace karst::test {

struct LabelledScan {
  core::LidarScan scan;
  std::vector<bool> of_dust;  // of each return; the others are rock, where the clear scan has it, too
};

/// Poses of a run's ground truth, one every `period_s` of flight.
inline std::vector<core::Pose> poses_of(const std::string& run_dir, double period_s) {
  std::ifstream tum(run_dir + "/ground_truth.tum");
  std::vector<core::Pose> poses;
  double due_s = 3;
  for (std::string line; std::getline(tum, line);) {
    std::istringstream words(line);
    double t = 0;
    core::Vec3 p;
    core::Quat q;
    words >> t >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
    if (t < due_s) continue;
    due_s += period_s;
    poses.push_back({p, q.normalized()});
  }
  return poses;
}

/// One kind of bad air.
/// Defaults: clear air, bare rock.
struct BadAir {
  std::string name;
  sim::AirOptions air;
  double cloud_1pm = 0;       // balls of droplets of 1.5 m radius, 3 m ahead, beside and behind
  double reflectivity = 0.5;  // of the rock
};

/// Measures from each pose, in clear and in bad air with the same noise.
inline std::vector<LabelledScan> scans_in(const BadAir& bad, const cave::Cave& clear_cave,
                                          const sim::Lidar& lidar, const std::vector<core::Pose>& poses) {
  std::vector<LabelledScan> scans;
  cave::Cave cave = clear_cave;
  cave.description.reflectivity = bad.reflectivity;
  constexpr double kRadius_m = 0.3;
  sim::CaveAir air(bad.air, {}, kRadius_m);
  core::Random place = core::Random::stream(1, "clouds of " + bad.name);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t_s = static_cast<double>(i);
    const core::Pose& T = poses[i];
    air.stir(t_s, T, cave.scene);
    sim::Air around{air.present(t_s + 0.5, T.position, true), core::Random::stream(i, bad.name)};
    if (bad.cloud_1pm > 0)
      for (const double angle : {0.0, 2.0, 4.0}) {
        cave::Cloud c;
        const double turn = angle + place.uniform(-0.5, 0.5);
        c.position = T * core::Vec3(3 * std::cos(turn), 3 * std::sin(turn), place.uniform(-0.5, 0.5));
        c.half_size_m.setConstant(1.5);
        c.extinction_1pm = bad.cloud_1pm;
        c.lidar_ratio_sr = cave::Cloud::kDroplets_sr;
        around.clouds.push_back(c);
      }
    const core::Random noise = core::Random::stream(i, "noise");
    const sim::PoseTrack track{{0, T}};
    const core::TimeNs stamp = 100 * core::kMillisecond;
    const core::LidarScan clear = lidar.sweep(cave, track, stamp, noise);
    LabelledScan s{lidar.sweep(cave, track, stamp, noise, around), {}};
    for (std::size_t k = 0; k < clear.range_m.size(); ++k)
      s.of_dust.push_back(std::isfinite(s.scan.range_m[k]) && s.scan.range_m[k] != clear.range_m[k]);
    scans.push_back(std::move(s));
  }
  return scans;
}

struct FilterFigures {
  double dust_fraction = 0;  // of all returns
  double removed = 0;        // share of the dust's returns, removed
  double rock_lost = 0;      // share of the rock's returns, removed
  double dust_left = 0;      // false returns a scan left
};

/// `filter` takes a LidarScan& and makes NaN of what it drops.
template <class Filter>
FilterFigures judge(const std::vector<LabelledScan>& scans, Filter&& filter) {
  double dust = 0, rock = 0, dust_removed = 0, rock_removed = 0;
  for (const LabelledScan& s : scans) {
    core::LidarScan filtered = s.scan;
    filter(filtered);
    for (std::size_t k = 0; k < s.of_dust.size(); ++k) {
      if (!std::isfinite(s.scan.range_m[k])) continue;
      const bool gone = !std::isfinite(filtered.range_m[k]);
      (s.of_dust[k] ? dust : rock) += 1;
      (s.of_dust[k] ? dust_removed : rock_removed) += gone;
    }
  }
  return {dust / (dust + rock), dust > 0 ? dust_removed / dust : 0, rock_removed / rock,
          (dust - dust_removed) / static_cast<double>(scans.size())};
}

}  // namespace karst::test
