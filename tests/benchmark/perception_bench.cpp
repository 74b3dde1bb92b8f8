// Dust filters on one scan of 65,536 beams in a generated cave full of haze, against PCL's outlier filters.
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>

#include <cmath>

#include "core_stack/perception/intensity_filter.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "plugins/simulator/sensors/lidar.h"
#include "tests/benchmark/times.h"

using namespace karst;

namespace {

pcl::PointCloud<pcl::PointXYZI>::Ptr cloud_of(const core::LidarScan& scan) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    if (!std::isfinite(scan.range_m[i])) continue;
    const int columns = scan.model->columns;
    const auto d = scan.model->direction(static_cast<int>(i) / columns, static_cast<int>(i) % columns);
    pcl::PointXYZI p;
    p.getVector3fMap() = scan.range_m[i] * d;
    p.intensity = scan.intensity[i];
    cloud->push_back(p);
  }
  return cloud;
}

/// Share of the false and of the true returns among what is left over.
void tell(const char* what, std::size_t false_before, std::size_t true_before, std::size_t false_left,
          std::size_t true_left) {
  std::printf("  %-44s false removed %5.1f %%, true lost %5.1f %%\n", what,
              100.0 * (1 - static_cast<double>(false_left) / static_cast<double>(false_before)),
              100.0 * (1 - static_cast<double>(true_left) / static_cast<double>(true_before)));
}

}  // namespace

int main() {
  const cave::GeneratedCave made = cave::generate_cave(cave::cave_preset("small"), 9);
  cave::CaveDescription description;
  description.start = made.start;
  const cave::Cave cave{description, cave::RayScene(made.mesh)};
  sim::LidarOptions unit;
  unit.unit = "os1_64";
  unit.columns = 1024;
  const sim::Lidar lidar(unit);
  const sim::PoseTrack track{{0, {made.start.position, core::Quat::Identity()}}};
  cave::Cloud haze;
  haze.half_size_m.setConstant(1e3);
  haze.extinction_1pm = 0.1;
  const core::TimeNs stamp = 100 * core::kMillisecond;
  const core::LidarScan clear = lidar.sweep(cave, track, stamp, core::Random(1)),
                        scan = lidar.sweep(cave, track, stamp, core::Random(1), {{haze}, core::Random(2)});
  std::size_t n_false = 0, n_true = 0;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (std::isfinite(scan.range_m[i])) (scan.range_m[i] == clear.range_m[i] ? n_true : n_false)++;
  std::printf("one scan of %zu beams: %zu returns of rock, %zu of dust\n", scan.range_m.size(), n_true,
              n_false);

  core::bench::Times weakest, lonely, statistical, radius;
  core::LidarScan one, other;
  for (int i = 0; i < 100; ++i) {
    one = other = scan;
    weakest.ms.push_back(core::bench::cpu_ms([&] { core::drop_weakest_returns(one, 10, 15); }));
    lonely.ms.push_back(core::bench::cpu_ms([&] { core::drop_lonely_returns(other, {}); }));
  }
  const auto cloud = cloud_of(scan);
  pcl::PointCloud<pcl::PointXYZI> kept_statistical, kept_radius;
  for (int i = 0; i < 5; ++i) {
    statistical.ms.push_back(core::bench::cpu_ms([&] {
      pcl::StatisticalOutlierRemoval<pcl::PointXYZI> filter;
      filter.setInputCloud(cloud);
      filter.setMeanK(8);
      filter.setStddevMulThresh(1.0);
      filter.filter(kept_statistical);
    }));
    radius.ms.push_back(core::bench::cpu_ms([&] {
      pcl::RadiusOutlierRemoval<pcl::PointXYZI> filter;
      filter.setInputCloud(cloud);
      filter.setRadiusSearch(0.2);
      filter.setMinNeighborsInRadius(4);
      filter.filter(kept_radius);
    }));
  }
  weakest.print("weakest tenth (the paper's)");
  lonely.print("lonely returns");
  statistical.print("pcl::StatisticalOutlierRemoval, 8 neighbours");
  radius.print("pcl::RadiusOutlierRemoval, 4 within 0.2 m");
  std::printf("  lonely takes %.3f of the statistical one's time, %.3f of the radius one's\n",
              lonely.at(0.5) / statistical.at(0.5), lonely.at(0.5) / radius.at(0.5));

  const auto left = [&](const core::LidarScan& filtered, const char* what) {
    std::size_t f = 0, t = 0;
    for (std::size_t i = 0; i < scan.range_m.size(); ++i)
      if (std::isfinite(filtered.range_m[i])) (scan.range_m[i] == clear.range_m[i] ? t : f)++;
    tell(what, n_false, n_true, f, t);
  };
  left(one, "weakest tenth");
  left(other, "lonely returns");
  // PCL gives points back: those of rock lie where the clear scan has one.
  const auto left_of = [&](const pcl::PointCloud<pcl::PointXYZI>& kept, const char* what) {
    std::vector<float> rock;
    for (std::size_t i = 0; i < scan.range_m.size(); ++i)
      if (std::isfinite(scan.range_m[i]) && scan.range_m[i] == clear.range_m[i]) {
        const int columns = scan.model->columns;
        rock.push_back((scan.range_m[i] *
                        scan.model->direction(static_cast<int>(i) / columns, static_cast<int>(i) % columns))
                           .x());
      }
    std::sort(rock.begin(), rock.end());
    std::size_t t = 0;
    for (const auto& p : kept) t += std::binary_search(rock.begin(), rock.end(), p.x);
    tell(what, n_false, n_true, kept.size() - t, t);
  };
  left_of(kept_statistical, "pcl::StatisticalOutlierRemoval");
  left_of(kept_radius, "pcl::RadiusOutlierRemoval");
}
