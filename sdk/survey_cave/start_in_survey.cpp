#include "sdk/survey_cave/start_in_survey.h"

#include <algorithm>
#include <utility>

namespace karst::survey_cave {
namespace {

using core::Vec3;
using Ranked = std::pair<double, Vec3>;

std::vector<Vec3> lowest_first(std::vector<Ranked> places, std::size_t most) {
  std::stable_sort(places.begin(), places.end(),
                   [](const Ranked& a, const Ranked& b) { return a.first < b.first; });
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < places.size() && i < most; ++i) out.push_back(places[i].second);
  return out;
}

/// Entrances by the length of their connected part.
std::vector<std::uint32_t> entrances_of(const survey::Survey& survey, const PassageGraph& graph,
                                        const std::vector<Tube>& tubes) {
  const std::vector<std::uint32_t> part = connected_parts(graph);
  std::vector<double> length_m(graph.size());
  for (const Tube& t : tubes) length_m[part[graph.node_of[survey.legs[t.leg()].from]]] += t.length_m();
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < graph.size(); ++i)
    if (std::any_of(graph.stations[i].begin(), graph.stations[i].end(),
                    [&](std::uint32_t s) { return survey.stations[s].entrance; }))
      nodes.push_back(i);
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return length_m[part[a]] > length_m[part[b]]; });
  return nodes;
}

}  // namespace

std::optional<cave::StartPose> start_in_survey(const cave::RayScene& scene, const survey::Survey& survey,
                                               const PassageGraph& graph, const Passages& passages) {
  constexpr double kFarthest_m = 60, kStep_m = 0.5;
  constexpr std::size_t kMostEntrances = 20, kMostTried = 300;
  const std::vector<std::uint32_t> entrances = entrances_of(survey, graph, passages.tubes);
  for (std::size_t i = 0; i < entrances.size() && i < kMostEntrances; ++i) {
    const std::vector<double> distance = distances_along(graph, {entrances[i]});
    std::vector<Ranked> places;
    for (const Tube& t : passages.tubes) {
      const survey::Leg& leg = survey.legs[t.leg()];
      const double a = distance[graph.node_of[leg.from]], b = distance[graph.node_of[leg.to]];
      if (std::min(a, b) > kFarthest_m) continue;
      const int steps = std::max(1, static_cast<int>(t.length_m() / kStep_m));
      for (int k = 0; k <= steps; ++k) {
        const double along = static_cast<double>(k) / steps;
        const double d = std::min(a + along * t.length_m(), b + (1 - along) * t.length_m());
        if (d <= kFarthest_m) places.emplace_back(d, t.middle_at(along));
      }
    }
    if (const auto start = cave::start_among(scene, lowest_first(std::move(places), kMostTried)))
      return start;
  }
  std::vector<Ranked> roomy;
  for (const Tube& t : passages.tubes) roomy.emplace_back(-t.size_at(0.5).minCoeff(), t.middle_at(0.5));
  if (const auto start = cave::start_among(scene, lowest_first(std::move(roomy), kMostTried))) return start;
  return cave::propose_start(scene);
}

}  // namespace karst::survey_cave
