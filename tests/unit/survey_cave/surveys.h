// Surveys written down in code.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/survey/survey.h"
#include "sdk/survey_cave/outline.h"

namespace karst::test {

/// Stations by name, legs between them, and sections as a reader gives them.
class SurveyMaker {
 public:
  survey::Survey survey;

  std::uint32_t station(const std::string& name, const core::Vec3& place) {
    survey::Station s;
    s.name = name;
    s.position_m = place;
    survey.stations.push_back(s);
    return static_cast<std::uint32_t>(survey.stations.size() - 1);
  }
  survey::Leg& leg(std::uint32_t from, std::uint32_t to, std::uint32_t run = 0) {
    survey::Leg l;
    l.from = from;
    l.to = to;
    l.run = run;
    survey.legs.push_back(l);
    return survey.legs.back();
  }
  survey::Section& section(std::uint32_t station, const core::Vec3& facing, double left_m, double right_m,
                           double up_m, double down_m, std::uint32_t run = 0) {
    survey::Section s;
    s.station = station;
    s.facing = facing;
    s.dimensions = {left_m, right_m, up_m, down_m};
    s.run = run;
    survey.sections.push_back(s);
    return survey.sections.back();
  }
  void splay(std::uint32_t station, const core::Vec3& from_station) {
    survey.splays.push_back({station, survey.stations[station].position_m + from_station, false, {}});
  }
};

/// A passage along +x whose walls are `half_m` from its stations, which are `step_m` apart.
inline SurveyMaker straight_passage(int legs, double step_m, double half_m) {
  SurveyMaker made;
  for (int i = 0; i <= legs; ++i) {
    made.station("cave." + std::to_string(i), {i * step_m, 0, 0});
    made.section(static_cast<std::uint32_t>(i), core::Vec3::UnitX(), half_m, half_m, half_m, half_m);
  }
  for (int i = 0; i < legs; ++i) made.leg(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1));
  return made;
}

/// Of |x/a|^p + |y/b|^p = 1, by the gamma function.
inline double superellipse_m2(double width_m, double height_m) {
  const double p = survey_cave::kExponent, g = std::tgamma(1 + 1 / p);
  return width_m * height_m * g * g / std::tgamma(1 + 2 / p);
}

struct Topology {
  std::size_t odd_edges = 0;  // not in exactly two triangles that run along them in opposite directions
  long euler = 0;             // vertices - edges + triangles: 2 for each surface like a ball's
  std::size_t surfaces = 0;   // connected ones
};

inline Topology topology_of(const cave::TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      ++runs[{t[i], t[(i + 1) % 3]}];
      parent[root(t[i])] = root(t[(i + 1) % 3]);
    }
  Topology found;
  for (const auto& [edge, n] : runs) {
    const auto back = runs.find({edge.second, edge.first});
    found.odd_edges += n != 1 || back == runs.end() || back->second != 1 ? 1u : 0u;
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) found.surfaces += root(i) == i ? 1u : 0u;
  found.euler = static_cast<long>(mesh.vertices.size()) - static_cast<long>(runs.size() / 2) +
                static_cast<long>(mesh.triangles.size());
  return found;
}

}  // namespace karst::test
