// How far the estimate of a link by the map is to be believed, by what it keeps to spare: of the links
// between landing places that a vehicle flew past, how many of those counted on stand, and how many of those
// that stand are counted on. `link_estimate_bench CAVE.info RUN...`, runs being folders with map.bt and
// trajectory.tum. A link stands where half of the packets get through, which is where the margin without
// fading is 0.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "core_stack/homing/landing/landing_ground.h"
#include "core_stack/homing/landing/link_estimate.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/radio/radio_link.h"
#include "sdk/evaluation/record/poses.h"

namespace karst {
namespace {

constexpr double kRadius_m = 0.3, kApart_m = 2.0;

struct Link {
  double expected_db, real_db;
};

/// Where a vehicle that comes down there by its own map really stands: on the rock, not on the map's cells.
core::Vec3 standing(const cave::Cave& cave, const core::Vec3& place) {
  constexpr double kDown_m = 2.0;
  return place + core::Vec3(0, 0, kRadius_m - cave.scene.ray_cast(place, {0, 0, -1}, kDown_m));
}

/// Where it could have landed, a vehicle's radius above the ground, at least 2 m apart.
std::vector<core::Vec3> landing_places(const core::VoxelMap& map, const std::filesystem::path& run) {
  std::vector<std::string> problems;
  std::vector<core::Vec3> out;
  for (const auto& pose : evaluation::read_tum(run / "trajectory.tum", problems)) {
    const core::Ground ground = core::ground_below(map, pose.T_world_body.position, kRadius_m, {});
    if (ground.verdict != core::GroundVerdict::good) continue;
    const core::Vec3 p = ground.ground + core::Vec3(0, 0, kRadius_m);
    bool apart = true;
    for (const core::Vec3& o : out) apart = apart && (o - p).norm() >= kApart_m;
    if (apart) out.push_back(p);
  }
  return out;
}

void add_links(const cave::Cave& cave, const std::filesystem::path& run, std::vector<Link>& links) {
  const core::VoxelMap map = core::read_octomap((run / "map.bt").string());
  core::LinkEstimateOptions estimate;
  estimate.spare_db = 0;
  const sim::LinkOptions radio;
  const std::vector<core::Vec3> places = landing_places(map, run);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((places[i] - places[j]).norm() < radio.range_m)
        links.push_back(
            {core::expected_margin_db(map, places[i], places[j], estimate),
             sim::link_margin_db(radio, cave.scene, standing(cave, places[i]), standing(cave, places[j]))});
  std::printf("%s: %zu places\n", run.c_str(), places.size());
}

void print(const std::vector<Link>& links) {
  std::size_t stand = 0;
  for (const Link& l : links) stand += l.real_db >= 0;
  std::printf("%zu pairs nearer than the range, %zu links stand\n", links.size(), stand);
  std::printf("%8s %10s %12s %22s\n", "spare dB", "counted on", "of them stand", "of standing counted on");
  for (const double spare_db : {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0}) {
    std::size_t counted = 0, both = 0;
    for (const Link& l : links)
      if (l.expected_db >= spare_db) ++counted, both += l.real_db >= 0;
    std::printf("%8.0f %10zu %11.1f %% %20.1f %%\n", spare_db, counted,
                100.0 * static_cast<double>(both) / static_cast<double>(counted),
                100.0 * static_cast<double>(both) / static_cast<double>(stand));
  }
}

}  // namespace
}  // namespace karst

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: link_estimate_bench CAVE.info RUN...\n");
    return 2;
  }
  try {
    const karst::cave::Cave cave = karst::cave::load_cave(argv[1], "");
    std::vector<karst::Link> links;
    for (int i = 2; i < argc; ++i) karst::add_links(cave, argv[i], links);
    karst::print(links);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
