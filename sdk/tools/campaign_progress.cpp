#include "sdk/tools/campaign_progress.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "core_stack/common/counted.h"
#include "core_stack/common/printable.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/terminal/terminal.h"

namespace karst::tools {
namespace {

using campaign::Plan;
using campaign::Progress;

template <class... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 256> line;
  std::snprintf(line.data(), line.size(), format, values...);
  return line.data();
}

std::string duration(double s) {
  const long all = std::lround(s);
  if (all < 60) return text("%ld s", all);
  if (all < 3600) return text("%ld min", (all + 30) / 60);
  return text("%ld h %02ld min", all / 3600, all % 3600 / 60);
}

/// Estimated from the pace since the start.
std::string time_left(const Progress& p) {
  if (p.here == 0) return "time left unknown";
  return duration(p.wall_s / static_cast<double>(p.here) * static_cast<double>(p.trials - p.finished)) +
         " left";
}

std::string bar(const Progress& p) {
  constexpr std::size_t kWidth = 24;
  const std::size_t full = p.trials ? kWidth * p.finished / p.trials : kWidth;
  return "[" + std::string(full, '#') + std::string(kWidth - full, '-') + "]";
}

double coverage_of(const campaign::StoredTrial& trial) {
  return trial.result.figures[static_cast<std::size_t>(evaluation::metric_index("coverage"))];
}

}  // namespace

CampaignProgress::CampaignProgress(bool quiet, std::size_t jobs)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), jobs_(jobs) {}

CampaignProgress::~CampaignProgress() {
  if (drawn_) std::fputs("\n", stderr);
}

void CampaignProgress::show(const Plan& plan, const Progress& p) {
  tallies_.resize(plan.contestants.size());
  if (quiet_) return;
  if (!begun_)
    print_error("%s: %s x %s x %s = %zu trials, %zu of them flown already\n", plan.name.c_str(),
                core::counted(plan.contestants.size(), "contestant").c_str(),
                core::counted(plan.caves.size(), "cave").c_str(),
                core::counted(plan.seeds.size(), "seed").c_str(), p.trials, p.finished);
  begun_ = true;
  if (p.last) {
    Tally& tally = tallies_[p.last->result.contestant];
    const double coverage = coverage_of(*p.last);  // a failed trial without a value counts as nothing found
    tally.coverage += std::isfinite(coverage) ? coverage : 0;
    ++tally.trials;
  }
  const std::string pace =
      p.simulated_s > 0 ? text(" · %.1f flight s a second", p.simulated_s / p.wall_s) : "";
  if (!terminal_) {
    if (!p.last) return;
    const campaign::TrialResult& r = p.last->result;
    const double coverage = coverage_of(*p.last);
    print_error("%zu/%zu · %s · %s, %s, seed %lld: %s%s%s%s\n", p.finished, p.trials, time_left(p).c_str(),
                plan.contestants[r.contestant].name.c_str(), plan.caves[r.cave].name.c_str(),
                static_cast<long long>(r.seed), r.outcome.c_str(),
                std::isfinite(coverage) ? text(", coverage %.1f %%", 100 * coverage).c_str() : "",
                r.failed ? ": " : "", r.failed ? r.reason.c_str() : "");
    return;
  }
  std::string found = "coverage so far:";
  for (std::size_t i = 0; i < tallies_.size(); ++i)
    if (tallies_[i].trials)
      found += text(" %s %.1f %%", core::printable(plan.contestants[i].name).c_str(),
                    100 * tallies_[i].coverage / tallies_[i].trials);
  std::string line = bar(p) + text(" %zu/%zu · %s", p.finished, p.trials, time_left(p).c_str()) + pace +
                     (p.failed ? text(" · %zu failed", p.failed) : "") +
                     (p.queue.empty() ? "" : " · " + core::printable(p.queue));
  const std::size_t width = terminal_columns(stderr);
  std::fprintf(stderr, "%s\r\033[K%s\n\033[K%s", drawn_ ? "\033[A" : "", line.substr(0, width).c_str(),
               found.substr(0, width - 1).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void CampaignProgress::say(const std::string& text) {
  if (quiet_) return;
  if (drawn_) std::fputs("\r\033[K\033[A\033[K", stderr);
  drawn_ = false;
  print_error("karst: %s\n", text.c_str());
}

}  // namespace karst::tools
