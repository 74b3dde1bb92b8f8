#include "sdk/evaluation/metrics/speed_limit_times.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace karst::evaluation {
namespace {

using core::SpeedLimit;
using core::Vec3;

constexpr double kLongestGap_s = 1.0;  // in the telemetry

std::vector<std::pair<double, SpeedLimit>> changes(const RunRecord& run) {
  std::vector<std::pair<double, SpeedLimit>> out;
  for (const nlohmann::json& e : run.events)
    if (const auto limit = core::event::as<core::event::SpeedLimit>(e))
      if (const auto t_s = event_number(e, "t")) out.emplace_back(*t_s, limit->by);
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

bool explores(const RunRecord& run, double t_s) {
  for (const Phase& p : run.phases)
    if (p.traits().explores && t_s >= p.begin_s && t_s <= p.end_s) return true;
  return false;
}

}  // namespace

double SpeedLimitTimes::total_s() const {
  double sum_s = 0;
  for (const SpeedLimitTime& t : of) sum_s += t.time_s;
  return sum_s;
}

SpeedLimitTimes speed_limit_times(const RunRecord& run, double until_s) {
  SpeedLimitTimes out;
  const auto limits = changes(run);
  const Table& table = run.telemetry;
  const auto *t_s = table.times(), *x = table.column("ref_x"), *y = table.column("ref_y"),
             *z = table.column("ref_z");
  if (limits.empty() || !t_s || !x || !y || !z) return out;
  SpeedLimit now = SpeedLimit::none;
  std::size_t next = 0;
  for (std::size_t i = 1; i < t_s->size() && (*t_s)[i] <= until_s; ++i) {
    const double before_s = (*t_s)[i - 1], dt_s = (*t_s)[i] - before_s;
    while (next < limits.size() && limits[next].first <= before_s) now = limits[next++].second;
    if (!(dt_s > 0 && dt_s < kLongestGap_s) || !explores(run, (*t_s)[i])) continue;
    const double step_m = Vec3((*x)[i] - (*x)[i - 1], (*y)[i] - (*y)[i - 1], (*z)[i] - (*z)[i - 1]).norm();
    if (!std::isfinite(step_m)) continue;
    out[now].time_s += dt_s;
    out[now].path_m += step_m;
  }
  return out;
}

const char* words_for(SpeedLimit limit) {
  switch (limit) {
    case SpeedLimit::none:
      return "at rest, turning on the spot, or stopping";
    case SpeedLimit::allowed:
      return "the greatest speed allowed";
    case SpeedLimit::sight:
      return "how far the sensors see the way";
    case SpeedLimit::room:
      return "rock beside the way";
    case SpeedLimit::narrow:
      return "narrow places";
    case SpeedLimit::bend:
      return "bends";
    case SpeedLimit::heading:
      return "the heading rate";
    case SpeedLimit::end:
      return "the end of the path";
    case SpeedLimit::speeding_up:
      return "the acceleration, speeding up";
  }
  return "";
}

}  // namespace karst::evaluation
