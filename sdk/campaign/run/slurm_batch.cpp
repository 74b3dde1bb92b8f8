#include "sdk/campaign/run/slurm_batch.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kEvaluationLimit_s = 1800;

}  // namespace

void write_batch(const fs::path& file, const Batch& batch) {
  json j{{"schema", "karst.batch/1"},
         {"karst", batch.karst.string()},
         {"timeout_s", batch.timeout_s},
         {"flying", batch.flying.string()},
         {"trials", json::array()}};
  for (const TrialJob& t : batch.trials)
    j["trials"].push_back(
        {{"command", t.command}, {"run_dir", t.run_dir.string()}, {"identity", t.identity}});
  evaluation::write_whole_file(file, core::json_text(j, 1));
}

bool fly_batch(const fs::path& file, const std::atomic<bool>* stop) {
  const json batch = core::json_of(core::read_input(file, core::kMaxTextFileBytes));
  std::vector<TrialJob> jobs;
  ExecutorOptions options;
  try {
    for (const json& t : batch.at("trials")) {
      TrialJob job{t.at("command"), t.at("run_dir").get<std::string>(), t.at("identity")};
      if (!is_flown(job)) jobs.push_back(job);
    }
    options.timeout_s = batch.at("timeout_s");
    options.flying = batch.at("flying").get<std::string>();
    options.finish = [karst = batch.at("karst").get<std::string>()](const fs::path& dir) {
      evaluate_record(karst, dir);
    };
  } catch (const json::exception& e) {
    throw core::InputError(file.string(), "", std::string("is no batch of trials: ") + e.what());
  }
  // What Slurm gave to the task: more than one CPU if the user asked for it, or if nodes are given as a
  // whole.
  if (const char* cpus = std::getenv("SLURM_CPUS_ON_NODE"))
    options.jobs = std::clamp<std::size_t>(std::strtoull(cpus, nullptr, 10), 1, 4096);
  options.stop = stop;
  return run_trials(jobs, options, {});
}

void evaluate_record(const fs::path& karst, const fs::path& run_dir) {
  if (fs::exists(run_dir / "mission.info") && !fs::exists(run_dir / "metrics.json"))
    host::run_process({karst.string(), "report", run_dir.string(), "--no-report"}, kEvaluationLimit_s);
}

}  // namespace karst::campaign
