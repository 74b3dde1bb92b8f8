// The round trip of a decision with a map of 20,000 m^3, for a policy that answers at once: a call of the C++
// function itself, through the ABI in this process, and in a process of its own. And what the snapshot costs,
// what the start of a process, and how much memory it takes.
//
// The map is a straight gallery, seen from a vehicle that flies through it: between two requests some ten
// scans change a few hundred blocks, as in four seconds of flight.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>

#include "core_stack/mapping/occupancy/voxel_classes.h"
#include "sdk/host/boundary/decision_box.h"
#include "sdk/host/isolation/isolated_policy.h"
#include "sdk/host/load_policy.h"
#include "sdk/host/serialization/flat_request.h"
#include "tests/benchmark/times.h"

namespace {

using namespace karst;
using Clock = std::chrono::steady_clock;

double elapsed_ms(Clock::time_point since) {
  return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

/// A gallery of 10 m diameter along x, with rock around. A scan from each metre adds what is seen within 12
/// m.
struct Gallery {
  core::VoxelMap map{core::MapOptions{}};
  core::Roadmap roadmap{core::PlanningOptions{}};
  double x = 0;

  void scan() {
    std::vector<core::Ray> rays;
    const core::Vec3f from(static_cast<float>(x), 0, 0);
    for (int i = 0; i < 64; ++i)
      for (int j = 0; j < 512; ++j) {
        const double up = (i - 31.5) / 64 * std::numbers::pi, around = j * std::numbers::pi / 256;
        const core::Vec3 d(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
        const double to_wall = 5.0 / std::hypot(d.y(), d.z());
        const bool hit = to_wall < 12;
        rays.push_back({from, from + (d * std::min(to_wall, 12.0)).cast<float>(), hit});
      }
    roadmap.update(map, map.insert(rays));
  }
};

/// What `plain` does, called as a C++ function.
core::Decision direct(const core::DecisionRequest& r) {
  core::Decision d;
  d.outcome = core::Outcome::goals;
  d.goals.push_back({r.state.position + r.direction_of_flight, 0, 0.5, 0, 0, 1, "ahead"});
  return d;
}

/// The most memory that a process has had in use.
double peak_memory_mib(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

struct Cycles {
  core::bench::Times standing, moving;  // nothing changed in the map; ten scans between two requests
};

}  // namespace

int main() {
  Gallery gallery;
  while (gallery.map.free_volume_m3() < 20000) gallery.scan(), gallery.x += 1;
  host::PolicyChoice choice;
  choice.name = "plain";
  const host::SearchPath path{{std::string(KARST_BINARY_DIR) + "/tests/plugins/plain.so"}, {}, 60.0};
  core::bench::Times start_here, start_there;
  const auto time_start = [&](core::bench::Times& times) {
    const auto begin = Clock::now();
    auto policy = host::load_policy(choice, path);
    times.ms.push_back(elapsed_ms(begin));
    return policy;
  };
  for (int i = 0; i < 20; ++i) time_start(start_here);
  const auto in_process = time_start(start_here);
  choice.isolation = host::Isolation::process;
  choice.hang_limit_s = 60;
  for (int i = 0; i < 20; ++i) time_start(start_there);
  const auto in_child = time_start(start_there);
  const pid_t child = dynamic_cast<const host::IsolatedPolicy&>(*in_child).process_id();
  const double at_start_mib = peak_memory_mib(child);

  std::vector<core::FrontierCluster> clusters(100);
  core::DecisionRequest request;
  request.map = &gallery.map, request.roadmap = &gallery.roadmap;
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    clusters[i].id = i + 1;
    clusters[i].cells.resize(50);
    request.frontiers.push_back({&clusters[i], {i * 10.0, 0, 0}, 0, i * 10.0});
  }
  std::printf("map of %.0f m^3, %zu known blocks; %zu clusters\n", gallery.map.free_volume_m3(),
              core::blocks_changed_after(gallery.map, 0).size(), clusters.size());

  Cycles by_call, by_abi, by_child;
  core::bench::Times snapshot, whole_snapshot, restart;
  std::size_t changed = 0, bytes = 0, checksum = 0;
  const auto time = [&](core::bench::Times& times, auto&& ask) {
    const auto begin = Clock::now();
    checksum += ask().goals.size();
    times.ms.push_back(elapsed_ms(begin));
  };
  const auto ask_all = [&](core::bench::Times Cycles::*kind) {
    ++request.sequence;
    time(by_call.*kind, [&] { return direct(request); });
    time(by_abi.*kind, [&] { return in_process->decide(request); });
    time(by_child.*kind, [&] { return in_child->decide(request); });
  };
  time(restart, [&] { return in_child->decide(request); });  // the whole map goes over
  for (int i = 0; i < 1000; ++i) ask_all(&Cycles::standing);
  constexpr int kMoves = 30;
  for (int i = 0; i < kMoves; ++i) {
    const std::uint64_t before = gallery.map.revision();
    for (int scan = 0; scan < 10; ++scan) gallery.scan(), gallery.x += 0.4;
    const auto begin = Clock::now();
    const host::Bytes flat = host::flatten(request, before);
    snapshot.ms.push_back(elapsed_ms(begin));
    bytes += flat.size();
    changed += core::blocks_changed_after(gallery.map, before).size();
    ask_all(&Cycles::moving);
  }
  for (int i = 0; i < 20; ++i) {
    const auto begin = Clock::now();
    checksum += host::flatten(request).size();
    whole_snapshot.ms.push_back(elapsed_ms(begin));
  }
  std::printf("round trip, nothing changed in the map (wall clock)\n");
  by_call.standing.print("direct C++ call");
  by_abi.standing.print("in process, through the ABI");
  by_child.standing.print("in a process of its own");
  std::printf("round trip, ten scans later: %zu blocks, %zu bytes of request a decision\n", changed / kMoves,
              bytes / kMoves);
  by_call.moving.print("direct C++ call");
  by_abi.moving.print("in process, through the ABI");
  by_child.moving.print("in a process of its own");
  std::printf("snapshot in it\n");
  snapshot.print("what changed, to bytes");
  whole_snapshot.print("the whole map, to bytes");
  restart.print("first request: the whole map, and the answer");
  std::printf("from the policy's name to its first request\n");
  start_here.print("in process");
  start_there.print("in a process of its own");
  std::printf("memory of that process: %.1f MiB at the start, %.1f MiB with the map at its largest\n",
              at_start_mib, peak_memory_mib(child));
  return checksum == 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
