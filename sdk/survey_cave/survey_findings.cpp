#include "sdk/survey_cave/survey_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "sdk/survey/lower_case.h"

namespace karst::survey_cave {
namespace {

using survey::Survey;

/// Words for water and rocks in the way, in the languages that surveys are often noted in.
bool names_obstacle(const std::string& comment) {
  constexpr std::array<std::string_view, 13> kWords{"sump",
                                                    "siphon",
                                                    "syphon",
                                                    "sifon",
                                                    "choke",
                                                    "blocked",
                                                    "boulder",
                                                    "collapse",
                                                    "tremie",
                                                    "tr\xc3\xa9mie",
                                                    "eboulis",
                                                    "\xc3\xa9"
                                                    "boulis",
                                                    "versturz"};
  const std::string lower = survey::lower_case(comment);
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view w) { return lower.find(w) != std::string::npos; });
}

void tell_of_parts(const Survey& survey, const PassageGraph& graph, const std::vector<Tube>& tubes,
                   SurveyReport& report) {
  const std::vector<std::uint32_t> part_of_node = connected_parts(graph);
  for (std::size_t i = 0; i < graph.size(); ++i) {
    if (part_of_node[i] == report.parts.size())
      report.parts.push_back({survey.stations[graph.stations[i].front()].name, 0, 0});
    report.parts[part_of_node[i]].stations += graph.stations[i].size();
  }
  for (const Tube& t : tubes)
    report.parts[part_of_node[graph.node_of[survey.legs[t.leg()].from]]].legs_m += t.length_m();
  std::stable_sort(report.parts.begin(), report.parts.end(),
                   [](const ConnectedPart& a, const ConnectedPart& b) { return a.legs_m > b.legs_m; });
}

void tell_of_guesses(const Survey& survey, const Passages& passages, SurveyReport& report) {
  std::map<std::string, GuessedSurvey> by_name;
  const auto row = [&](std::uint32_t leg) -> GuessedSurvey& {
    return by_name[survey_of(survey.stations[survey.legs[leg].from].name)];
  };
  for (const Tube& t : passages.tubes) row(t.leg()).legs_m += t.length_m();
  for (const GuessedLeg& g : passages.guessed) {
    row(g.leg).without_m += g.without_m;
    row(g.leg).partly_m += g.partly_m;
    report.dimensions.without_m += g.without_m;
    report.dimensions.partly_m += g.partly_m;
  }
  for (auto& [name, guessed] : by_name) {
    guessed.name = name;
    if (guessed.without_m + guessed.partly_m > 0) report.dimensions.guessed.push_back(guessed);
  }
  std::stable_sort(report.dimensions.guessed.begin(), report.dimensions.guessed.end(),
                   [](const GuessedSurvey& a, const GuessedSurvey& b) {
                     return a.without_m != b.without_m ? a.without_m > b.without_m : a.partly_m > b.partly_m;
                   });
}

}  // namespace

double narrow_m(const Tube& tube, double width_m) {
  constexpr double kStep_m = 0.5, kMostSteps = 2000;
  const int steps = static_cast<int>(std::clamp(std::ceil(tube.length_m() / kStep_m), 2.0, kMostSteps));
  double narrow = 0;
  for (int i = 0; i <= steps; ++i)
    if (tube.size_at(static_cast<double>(i) / steps).minCoeff() < width_m)
      narrow += i == 0 || i == steps ? 0.5 : 1.0;
  return tube.length_m() * narrow / steps;
}

void tell_of_passages(const Survey& survey, const SurveyPart& part, const PassageGraph& graph,
                      const Passages& passages, SurveyReport& report) {
  double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
  std::vector<bool> in_part(survey.stations.size());
  for (const std::uint32_t i : part.stations) {
    const survey::Station& s = survey.stations[i];
    in_part[i] = true;
    highest = std::max(highest, s.position_m.z());
    lowest = std::min(lowest, s.position_m.z());
    report.entrances += s.entrance ? 1u : 0u;
    if (names_obstacle(s.comment)) report.obstacles.blocked.push_back({s.name, s.comment});
    if (s.continuation) report.obstacles.continuations.push_back(s.name);
  }
  report.stations = part.stations.size();
  report.depth_m = highest - lowest;
  report.legs = passages.tubes.size();
  for (const survey::Splay& s : survey.splays) report.splays += in_part[s.station] && !s.surface ? 1u : 0u;
  report.surface_m = part.surface_m;
  report.duplicate_m = part.duplicate_m;
  for (const Tube& t : passages.tubes) {
    report.passage_m += t.length_m();
    if (survey.legs[t.leg()].underwater()) report.obstacles.flooded_m += t.length_m();
    report.obstacles.narrow_m += narrow_m(t, report.obstacles.vehicle_width_m);
  }
  report.rest_m = std::max(0.0, part.whole_m - report.passage_m);
  report.dimensions.defaults_m = passages.defaults_m;
  report.dimensions.half_width_m = passages.measured_half_width_m;
  report.dimensions.up_m = passages.measured_up_m;
  report.dimensions.down_m = passages.measured_down_m;
  report.dimensions.splays_m = passages.splays_m;
  report.dimensions.shafts_m = passages.shafts_m;
  report.dimensions.widened_m = passages.widened_m;
  report.dimensions.sections_from_splays = passages.sections_from_splays;
  tell_of_guesses(survey, passages, report);
  tell_of_parts(survey, graph, passages.tubes, report);
}

double within_reach_m(const Survey& survey, const PassageGraph& graph, const Passages& passages,
                      double width_m, const core::Vec3& from) {
  std::vector<bool> wide(survey.legs.size());
  const Tube* around = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Tube& t : passages.tubes) {
    wide[t.leg()] = narrow_m(t, width_m) == 0;
    if (const double d = t.far_distance(from) < nearest ? t.distance(from) : nearest; d < nearest) {
      nearest = d;
      around = &t;
    }
  }
  if (around == nullptr) return 0;
  const survey::Leg& first = survey.legs[around->leg()];
  const std::vector<double> distance =
      distances_along(graph, {graph.node_of[first.from], graph.node_of[first.to]}, &wide);
  double reached = 0;
  for (const Tube& t : passages.tubes)
    if (wide[t.leg()] && std::isfinite(distance[graph.node_of[survey.legs[t.leg()].from]]))
      reached += t.length_m();
  return reached;
}

}  // namespace karst::survey_cave
