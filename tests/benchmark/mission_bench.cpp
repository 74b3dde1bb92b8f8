// A whole mission with a 16 x 1024 LiDAR, two minutes of flight: simulated seconds per second on the clock,
// and where the time goes.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"

int main() {
  using namespace karst;
  const auto folder = fresh_folder("mission_bench");
  std::printf("%-12s %10s %12s\n", "threads", "flight s", "flight s / s");
  nlohmann::json timing;
  for (const char* threads : {"1", "2"}) {
    const auto run = folder / threads;
    const Output out = run_karst("fly --cave " + generated_cave("small", 7) +
                                 " --set simulator.lidar.unit=vlp16 --set simulator.lidar.columns=1024"
                                 " --set mission.max_flight_time=180s --quiet --no-report --threads " +
                                 threads + " --out " + run.string());
    if (out.code != 0) {
      std::printf("the mission failed:\n%s\n", out.text.c_str());
      return 1;
    }
    timing = nlohmann::json::parse(bytes_of(run / "timing.json"));
    std::printf("%-12s %10.0f %12.2f\n", threads, timing["simulated_s"].get<double>(),
                timing["simulated_s_per_wall_s"].get<double>());
  }
  std::printf(
      "\nwhere the time goes with 2 threads (jobs overlap: vehicle and control run beside the others)\n");
  std::printf("%-16s %8s %9s %9s %9s\n", "job", "count", "total s", "mean ms", "p99 ms");
  for (const auto& [name, job] : timing["jobs"].items())
    std::printf("%-16s %8d %9.2f %9.3f %9.3f\n", name.c_str(), job["count"].get<int>(),
                job["total_s"].get<double>(), job["mean_ms"].get<double>(), job["p99_ms"].get<double>());
}
