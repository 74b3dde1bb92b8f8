#include "sdk/cave_drawing/leg_walls.h"

#include <cmath>
#include <vector>

#include "sdk/survey_cave/passage_graph.h"

namespace karst::cave_drawing {
namespace {

/// A mean of what several sections say of a station.
class MeanAtNode {
 public:
  void add(double value) { sum_ += value, ++count_; }
  std::optional<double> mean() const { return count_ == 0 ? std::nullopt : std::optional(sum_ / count_); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

survey_cave::SurveyPart underground(const survey::Survey& survey) {
  survey_cave::SurveyPart part;
  std::vector<bool> used(survey.stations.size());
  for (std::uint32_t i = 0; i < survey.legs.size(); ++i) {
    if (survey.legs[i].surface) continue;
    part.legs.push_back(i);
    used[survey.legs[i].from] = used[survey.legs[i].to] = true;
  }
  for (std::uint32_t i = 0; i < survey.stations.size(); ++i)
    if (used[i]) part.stations.push_back(i);
  return part;
}

std::vector<std::optional<double>> interpolated_means(const survey_cave::PassageGraph& graph,
                                                      const std::vector<MeanAtNode>& means) {
  std::vector<std::optional<double>> known;
  for (const MeanAtNode& m : means) known.push_back(m.mean());
  return survey_cave::interpolated(graph, known);
}

/// The way ahead, seen from above; north along a shaft.
core::Vec3 facing_along(const core::Vec3& from, const core::Vec3& to) {
  const core::Vec3 ahead(to.x() - from.x(), to.y() - from.y(), 0);
  return ahead.norm() < 0.01 ? core::Vec3(core::Vec3::UnitY()) : core::Vec3(ahead.normalized());
}

}  // namespace

LegWalls::LegWalls(const survey::Survey& survey) : survey_(survey), between_(survey.stations.size()) {
  const survey_cave::PassageGraph graph =
      survey_cave::graph_of(survey, underground(survey), core::Vec3::Zero());
  std::vector<MeanAtNode> half_width(graph.size()), up(graph.size()), down(graph.size());
  for (std::size_t i = 0; i < survey.sections.size(); ++i) {
    const survey::Section& s = survey.sections[i];
    const survey::Dimensions& d = s.dimensions;
    if (!d.any()) continue;
    of_run_.emplace(std::pair(s.station, s.run), i);
    of_station_.emplace(s.station, i);
    const std::uint32_t node = graph.node_of[s.station];
    if (node == survey_cave::kNoNode) continue;
    if (d.left_m && d.right_m) half_width[node].add(0.5 * (*d.left_m + *d.right_m));
    if (d.up_m) up[node].add(*d.up_m);
    if (d.down_m) down[node].add(*d.down_m);
  }
  const auto widths = interpolated_means(graph, half_width), ups = interpolated_means(graph, up),
             downs = interpolated_means(graph, down);
  for (std::size_t i = 0; i < between_.size(); ++i)
    if (const std::uint32_t node = graph.node_of[i]; node != survey_cave::kNoNode)
      between_[i] = {widths[node], widths[node], ups[node], downs[node]};
}

const survey::Section* LegWalls::section_at(std::uint32_t station, std::uint32_t run) const {
  if (const auto own = of_run_.find({station, run}); own != of_run_.end())
    return &survey_.sections[own->second];
  const auto other = of_station_.find(station);
  return other == of_station_.end() ? nullptr : &survey_.sections[other->second];
}

LegEnd LegWalls::end_of(std::uint32_t station, const core::Vec3& facing,
                        const survey::Dimensions& dimensions) const {
  LegEnd end;
  end.station = end.left = end.right = survey_.stations[station].position_m;
  const core::Vec3 to_left(-facing.y(), facing.x(), 0);
  const double left_m = dimensions.left_m.value_or(0), right_m = dimensions.right_m.value_or(0);
  end.left += left_m * to_left;
  end.right -= right_m * to_left;
  end.width_m = left_m + right_m;
  end.up_m = dimensions.up_m.value_or(0);
  end.down_m = dimensions.down_m.value_or(0);
  return end;
}

LegPassage LegWalls::of(const survey::Leg& leg) const {
  const std::array<std::uint32_t, 2> stations{leg.from, leg.to};
  const std::array<const survey::Section*, 2> sections{section_at(leg.from, leg.run),
                                                       section_at(leg.to, leg.run)};
  const bool any = sections[0] != nullptr || sections[1] != nullptr;
  LegPassage passage;
  for (std::size_t i = 0; i < 2; ++i) {
    const core::Vec3 facing = sections[i] != nullptr ? sections[i]->facing
                                                     : facing_along(survey_.stations[leg.from].position_m,
                                                                    survey_.stations[leg.to].position_m);
    const survey::Dimensions noted = sections[i] != nullptr ? sections[i]->dimensions : survey::Dimensions{};
    survey::Dimensions filled = noted;
    const survey::Dimensions& between = between_[stations[i]];
    if (any) {
      if (!filled.left_m) filled.left_m = between.left_m;
      if (!filled.right_m) filled.right_m = between.right_m;
      if (!filled.up_m) filled.up_m = between.up_m;
      if (!filled.down_m) filled.down_m = between.down_m;
    }
    passage.drawn[i] = end_of(stations[i], facing, filled);
    passage.measured[i] = end_of(stations[i], facing, noted);
  }
  return passage;
}

bool is_steep(const std::array<LegEnd, 2>& ends) {
  const core::Vec3 d = ends[1].station - ends[0].station;
  return std::abs(d.z()) > d.head<2>().norm();
}

}  // namespace karst::cave_drawing
