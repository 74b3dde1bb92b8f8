// A decision of one policy in Python and of its twin in C++, with 100, 1,000 and 4,096 frontiers: in this
// process and in a process of its own; and what the start of each takes. The twins are my_nearest of the
// tutorials.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "sdk/host/load_policy.h"
#include "tests/benchmark/times.h"

namespace {

using namespace karst;
using Clock = std::chrono::steady_clock;

constexpr int kStarts = 10, kDecisions = 300;

double elapsed_ms(Clock::time_point since) {
  return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

std::unique_ptr<host::HostedPolicy> loaded(const std::string& file, host::Isolation isolation) {
  host::PolicyChoice choice;
  choice.name = "my_nearest";
  choice.isolation = isolation;
  choice.hang_limit_s = 60;
  return host::load_policy(choice, {{file}, {}, 60.0});
}

/// A request with frontiers of known ways.
struct Question {
  core::VoxelMap map{core::MapOptions{}};
  core::Roadmap roadmap{core::PlanningOptions{}};
  std::vector<core::FrontierCluster> clusters;
  core::DecisionRequest request;

  explicit Question(std::size_t frontiers) : clusters(frontiers) {
    for (int i = 0; i < 50; ++i) map.assign({i, 0, 0}, 1, -2.0f);
    request.map = &map, request.roadmap = &roadmap;
    for (std::uint32_t i = 0; i < clusters.size(); ++i) {
      clusters[i].id = i + 1;
      clusters[i].cells.resize(50);
      request.frontiers.push_back({&clusters[i], {i * 0.1, 0, 0}, 0, 1 + (i * 7919u) % 1000 * 0.1});
    }
  }
};

}  // namespace

int main() {
  const std::string compiled = KARST_BINARY_DIR "/tests/benchmark/my_nearest.so",
                    script = KARST_SOURCE_DIR "/examples/policies/python/my_nearest.py";
  std::size_t goals = 0;
  for (const auto& [isolation, where] : {std::pair(host::Isolation::in_process, "in process"),
                                         std::pair(host::Isolation::process, "in a process of its own")}) {
    std::printf("%s\n", where);
    core::bench::Times start_compiled, start_script;
    for (int i = 0; i < kStarts; ++i)
      for (const auto& [file, times] :
           {std::pair(&compiled, &start_compiled), std::pair(&script, &start_script)}) {
        const auto begin = Clock::now();
        loaded(*file, isolation);
        times->ms.push_back(elapsed_ms(begin));
      }
    start_compiled.print("start, C++");
    start_script.print("start, Python");
    const auto in_cpp = loaded(compiled, isolation), in_python = loaded(script, isolation);
    for (const std::size_t frontiers : {100u, 1000u, 4096u}) {
      Question question(frontiers);
      core::bench::Times cpp, python;
      for (int i = 0; i < kDecisions; ++i) {
        ++question.request.sequence;
        for (const auto& [policy, times] :
             {std::pair(in_cpp.get(), &cpp), std::pair(in_python.get(), &python)}) {
          const auto begin = Clock::now();
          goals += policy->decide(question.request).goals.size();
          times->ms.push_back(elapsed_ms(begin));
        }
      }
      const std::string n = std::to_string(frontiers) + " frontiers";
      cpp.print((n + ", C++").c_str());
      python.print((n + ", Python").c_str());
    }
  }
  return goals > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
