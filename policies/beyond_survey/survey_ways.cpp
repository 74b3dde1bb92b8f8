#include "survey_ways.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace beyond_survey {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double length_m(const karst::SurveyLeg& leg) { return karst::distance(leg.from, leg.to); }

}  // namespace

/// Dijkstra's search from all of these leads at once.
void SurveyWays::lead_to(const std::vector<bool>& open) {
  std::size_t stations = 0;
  for (const karst::SurveyLeg& l : legs_)
    stations = std::max<std::size_t>(stations, std::max(l.from_station, l.to_station) + 1);
  std::vector<std::vector<std::size_t>> legs_at(stations);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    legs_at[legs_[i].from_station].push_back(i);
    legs_at[legs_[i].to_station].push_back(i);
  }
  bool some_marked = false;
  for (std::size_t i = 0; i < leads_.size(); ++i)
    some_marked = some_marked || (open[i] && leads_[i].kind == KARST_LEAD_CONTINUATION);

  to_lead_m_.assign(stations, kInfinity);
  using Reached = std::pair<double, std::uint64_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto reach = [&](std::uint64_t station, double way_m) {
    if (way_m >= to_lead_m_[station]) return;
    to_lead_m_[station] = way_m;
    next.emplace(way_m, station);
  };
  for (std::size_t i = 0; i < leads_.size(); ++i)
    if (open[i] && (!some_marked || leads_[i].kind == KARST_LEAD_CONTINUATION) &&
        leads_[i].station < stations)
      reach(leads_[i].station, 0);
  while (!next.empty()) {
    const auto [way_m, station] = next.top();
    next.pop();
    if (way_m > to_lead_m_[station]) continue;
    for (const std::size_t i : legs_at[station])
      reach(legs_[i].from_station == station ? legs_[i].to_station : legs_[i].from_station,
            way_m + length_m(legs_[i]));
  }
}

double SurveyWays::way_m(const karst::Vec3& from) const {
  double nearest_m = kInfinity, way_m = kInfinity;
  for (const karst::SurveyLeg& l : legs_) {
    const karst::Vec3 a = l.from, along = karst::Vec3(l.to) - a;
    const double squared = karst::dot(along, along);
    const double t = squared > 0 ? std::clamp(karst::dot(from - a, along) / squared, 0.0, 1.0) : 0.0;
    const double away_m = karst::distance(from, a + t * along);
    if (away_m >= nearest_m) continue;
    nearest_m = away_m;
    way_m = away_m + std::min(t * length_m(l) + to_lead_m_[l.from_station],
                              (1 - t) * length_m(l) + to_lead_m_[l.to_station]);
  }
  return way_m;
}

}  // namespace beyond_survey
