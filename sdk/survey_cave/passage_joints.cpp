#include "sdk/survey_cave/passage_joints.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sdk/survey/place_sets.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using survey::Survey;

double smooth_step(double v, double low, double high) {
  const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vec3 horizontal(const Vec3& v) { return {v.x(), v.y(), 0}; }

std::vector<Way> ways_of(const Survey& survey, const SurveyPart& part, const PassageGraph& graph) {
  constexpr double kGentle = 0.75, kShaft = 0.95;  // sines of the slope
  std::vector<Way> ways;
  for (const std::uint32_t leg : part.legs) {
    Way w;
    w.leg = leg;
    w.node = {graph.node_of[survey.legs[leg].from], graph.node_of[survey.legs[leg].to]};
    const Vec3 d = graph.places[w.node[1]] - graph.places[w.node[0]];
    w.length_m = d.norm();
    if (w.length_m < 0.01) continue;
    w.axis = d / w.length_m;
    w.steep = smooth_step(std::abs(w.axis.z()), kGentle, kShaft);
    const Vec3 level = horizontal(w.axis);
    w.normal =
        w.steep < 1 ? Vec3((1 - w.steep) * level.normalized() + w.steep * w.axis).normalized() : w.axis;
    ways.push_back(w);
  }
  return ways;
}

/// The pairs of ends at a node that go on as one passage, and the ends that are left over.
std::vector<Joint> paired(const std::vector<Way>& ways, std::size_t nodes) {
  constexpr double kLeastStraight = 0.17;  // cosine of the sharpest turn, 80 degrees
  constexpr std::size_t kMostPaired = 64;  // ends at one node: a splay shot that was not marked as such
  std::vector<std::vector<WayEnd>> at(nodes);
  for (std::uint32_t i = 0; i < ways.size(); ++i)
    for (const std::size_t end : {0, 1}) at[ways[i].node[end]].push_back({i, end});
  const auto outwards = [&](const WayEnd& e) -> Vec3 {
    return (e.end == 0 ? 1.0 : -1.0) * ways[e.way].normal;
  };
  std::vector<Joint> joints;
  for (std::uint32_t node = 0; node < nodes; ++node) {
    const std::vector<WayEnd>& ends = at[node];
    struct Pair {
      double straight;
      std::size_t i, j;
    };
    std::vector<Pair> pairs;
    if (ends.size() <= kMostPaired)
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1; j < ends.size(); ++j)
          if (const double s = -outwards(ends[i]).dot(outwards(ends[j])); s >= kLeastStraight)
            pairs.push_back({s, i, j});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.straight > b.straight; });
    std::vector<bool> taken(ends.size());
    const auto add = [&](std::vector<WayEnd> of, const Vec3& normal) {
      Joint j;
      j.node = node;
      j.normal = normal.normalized();
      for (const WayEnd& e : of) j.steep += ways[e.way].steep / static_cast<double>(of.size());
      j.ends = std::move(of);
      joints.push_back(std::move(j));
    };
    for (const Pair& p : pairs) {
      if (taken[p.i] || taken[p.j]) continue;
      taken[p.i] = taken[p.j] = true;
      add({ends[p.i], ends[p.j]}, outwards(ends[p.j]) - outwards(ends[p.i]));
    }
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (!taken[i]) add({ends[i]}, outwards(ends[i]));
  }
  return joints;
}

}  // namespace

bool is_shaft(const Joint& joint) { return horizontal(joint.normal).norm() < 0.3; }

PassageJoints joints_of(const Survey& survey, const SurveyPart& part, const PassageGraph& graph) {
  PassageJoints made;
  made.ways = ways_of(survey, part, graph);
  made.joints = paired(made.ways, graph.size());
  for (std::uint32_t i = 0; i < made.joints.size(); ++i)
    for (const WayEnd& e : made.joints[i].ends) made.ways[e.way].joint[e.end] = i;
  return made;
}

std::vector<std::uint32_t> passage_numbers(const PassageJoints& joints) {
  survey::PlaceSets passages(joints.ways.size());
  for (const Joint& j : joints.joints)
    if (j.ends.size() == 2) passages.unite(j.ends[0].way, j.ends[1].way);
  std::vector<std::uint32_t> first(joints.ways.size(), kNoNode), number;  // first: of a set, by its root
  for (std::uint32_t i = 0; i < joints.ways.size(); ++i) {
    std::uint32_t& lowest = first[passages.root(i)];
    lowest = std::min(lowest, i);
    number.push_back(lowest);
  }
  return number;
}

}  // namespace karst::survey_cave
