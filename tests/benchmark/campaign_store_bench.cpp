// What the one writer of a campaign's store can do: rows (trials with their curves) a second.
//   campaign_store_bench FOLDER [TRIALS...]
// FOLDER is on the disk to measure; the same in memory (/dev/shm) shows what of it is computing.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "sdk/campaign/store/store.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace {

namespace fs = std::filesystem;
using namespace karst::campaign;

constexpr std::size_t kContestants = 8, kCaves = 40, kCurvePoints = 151;  // 300 s of flight

double cpu_s() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

StoreHead head_of(std::size_t trials) {
  StoreHead head{"bench", std::string(20000, ' '), 300, {}, {}, {}};  // a definition of 20 kB
  for (std::size_t k = 0; k < kContestants; ++k)
    head.contestants.push_back({"contestant_" + std::to_string(k), "policy", "1.0.0", "{}", "{}"});
  for (std::size_t c = 0; c < kCaves; ++c) {
    const std::string name = "cave_" + std::to_string(c);
    head.caves.push_back({name, "/caves/" + name + ".info", "", "", "abc"});
  }
  for (std::size_t s = 0; s <= trials / (kContestants * kCaves); ++s)
    head.seeds.push_back(static_cast<std::int64_t>(s) + 1);
  return head;
}

StoredTrial trial_of(std::size_t i) {
  StoredTrial t;
  t.result.contestant = i % kContestants;
  t.result.cave = i / kContestants % kCaves;
  t.result.seed = static_cast<std::int64_t>(i / (kContestants * kCaves)) + 1;
  t.result.outcome = "landed";
  t.result.reason = "at the start";
  t.result.run_dir = "trials/contestant/cave/1";
  t.result.figures.assign(karst::evaluation::metric_definitions().size(), 0.1234567 * static_cast<double>(i));
  for (std::size_t p = 0; p < kCurvePoints; ++p) {
    const auto x = static_cast<double>(p);
    t.result.curve.push_back({2 * x, 31.7 * x, x / 160});
  }
  t.binary_version = "0.1.0+abc";
  t.mission_hash = std::string(64, 'a');
  t.timing.machine = "node";
  return t;
}

void measure(const fs::path& folder, std::size_t trials, std::size_t at_once) {
  const fs::path file = folder / ("campaign_store_bench-" + std::to_string(getpid()) + ".sqlite");
  fs::remove(file);
  {
    Store store = Store::create(file, head_of(trials));
    const double cpu = cpu_s();
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < trials; i += at_once) {
      std::vector<StoredTrial> some;
      for (std::size_t k = i; k < std::min(i + at_once, trials); ++k) some.push_back(trial_of(k));
      store.add(some);
    }
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const auto n = static_cast<double>(trials);
    std::printf(
        "%-12s %6zu trials, %3zu at once  %8.1f rows/s  %6.2f ms a row  %6.2f ms of them CPU  %5.1f kB a "
        "row\n",
        folder.c_str(), trials, at_once, n / wall, 1e3 * wall / n, 1e3 * (cpu_s() - cpu) / n,
        static_cast<double>(fs::file_size(file)) / n / 1e3);
  }
  fs::remove(file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: campaign_store_bench FOLDER [TRIALS...]\n");
    return 1;
  }
  std::vector<std::size_t> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
  if (sizes.empty()) sizes = {1000, 10000};
  for (const std::size_t trials : sizes)
    for (const std::size_t at_once : {1, 10, 100}) measure(argv[1], trials, at_once);
}
