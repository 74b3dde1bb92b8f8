// What a picture of the colour camera costs, and the account of what it shows, next to a LiDAR sweep of the
// same place in the same run.
#include "core_stack/mapping/frontiers/imaged_surface.h"
#include "core_stack/mission/recording/picture_file.h"
#include "plugins/simulator/cameras/rgb_camera.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "plugins/simulator/sensors/lidar.h"
#include "tests/benchmark/times.h"

using namespace karst;
using core::bench::cpu_ms;

int main() {
  const cave::GeneratedCave made = cave::generate_cave(cave::cave_preset("small"), 9);
  cave::CaveDescription description;
  description.start = made.start;
  const cave::Cave cave{description, cave::RayScene(made.mesh)};
  const sim::Lidar lidar({});
  const sim::RgbCamera camera({});
  core::Pose T{made.start.position, core::Quat::Identity()};

  core::VoxelMap map{core::MapOptions{}};
  core::StateHistory history;
  core::State state;
  state.position = T.position;
  history.push(state);
  core::bench::Times sweep, picture, file, account, index, looks;
  sim::Air haze;
  haze.clouds.push_back({});
  haze.clouds[0].half_size_m.setConstant(1e3);
  haze.clouds[0].extinction_1pm = 0.05;
  core::bench::Times hazy;
  core::ImagedSurface imaged;
  for (int i = 0; i < 40; ++i) {
    T.orientation = core::from_heading(0.3 * i);
    core::LidarScan scan;
    const sim::PoseTrack track{{0, T}};
    sweep.ms.push_back(
        cpu_ms([&] { scan = lidar.sweep(cave, track, 100 * core::kMillisecond, core::Random(1)); }));
    core::RgbFrame frame{0, camera.model(), {}};
    picture.ms.push_back(cpu_ms([&] { frame.rgb = camera.picture(cave, T, core::Random(1)); }));
    hazy.ms.push_back(cpu_ms([&] { camera.picture(cave, T, core::Random(1), haze); }));
    file.ms.push_back(cpu_ms([&] { core::jpeg_of(frame); }));
    if (i == 0) map.insert(core::to_rays(scan, history, 0.35, 30));
    const core::Pose T_world_camera = T * camera.model()->camera.T_body_camera;
    std::optional<core::UnimagedSurface> unimaged;
    index.ms.push_back(cpu_ms([&] { unimaged.emplace(map, imaged); }));
    looks.ms.push_back(cpu_ms([&] {
      for (int k = 0; k < 100; ++k) unimaged->seen_from(T_world_camera, *camera.model());
    }));
    account.ms.push_back(cpu_ms([&] { imaged.take(map, T_world_camera, *camera.model()); }));
  }
  std::printf("LiDAR: %zu beams; pictures: %d x %d pixels\n",
              static_cast<std::size_t>(lidar.model()->columns) * lidar.model()->elevation_rad.size(),
              camera.model()->camera.width, camera.model()->camera.height);
  sweep.print("LiDAR sweep (the reference)");
  picture.print("picture");
  hazy.print("picture in haze");
  file.print("picture to JPEG");
  account.print("account of a picture");
  index.print("surface not imaged yet, once a request");
  looks.print("100 looks foreseen");
  const double unit = sweep.at(0.5);
  std::printf("over the sweep: picture %.1f, in haze %.1f, JPEG %.2f, account %.2f, 100 looks %.2f\n",
              picture.at(0.5) / unit, hazy.at(0.5) / unit, file.at(0.5) / unit, account.at(0.5) / unit,
              looks.at(0.5) / unit);
}
