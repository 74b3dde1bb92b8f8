#include "sdk/survey_cave/passages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sdk/survey_cave/section_sizes.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using survey::Survey;

double reach_of(const Extents& e) {
  return std::hypot(std::max(e.left_m, e.right_m), std::max(e.up_m, e.down_m));
}

/// Whether the section halves the angle between its two legs: the planes of a leg's ends must not meet within
/// the passage.
bool is_mitred(const Joint& joint, const std::vector<Way>& ways, const SectionSizes& sizes) {
  constexpr double kMostTilt = 0.35, kLeastAlong = 0.35;
  if (joint.ends.size() < 2) return false;
  return std::all_of(joint.ends.begin(), joint.ends.end(), [&](const WayEnd& e) {
    const Way& w = ways[e.way];
    const double along = std::abs(joint.normal.dot(w.normal));
    const double reach =
        std::max(reach_of(sizes.at[w.joint[0]].extents), reach_of(sizes.at[w.joint[1]].extents));
    const double tilt = std::sqrt(std::max(0.0, 1 - along * along)) / std::max(along, 1e-6);
    return std::abs(joint.normal.dot(w.axis)) >= kLeastAlong && tilt * reach <= kMostTilt * w.length_m;
  });
}

/// Looks the other way: left is right, and at a shaft front is back.
Extents turned(const Extents& e, bool upside_down) {
  return upside_down ? Extents{e.right_m, e.left_m, e.down_m, e.up_m}
                     : Extents{e.right_m, e.left_m, e.up_m, e.down_m};
}

struct SectionMade {
  TubeEnd end;
  bool from_splays = false, widened = false;
};

class TubeMaker {
 public:
  TubeMaker(const PassageGraph& graph, const Splays& splays, double least_m)
      : graph_(graph), splays_(splays), least_m_(least_m) {}

  /// The section of a joint as an end of a way. `left` of the way's other end, if it is made already, is the
  /// one to agree with.
  SectionMade section(const Joint& joint, const SectionSize& size, const Way& way, std::size_t end,
                      bool mitred, const Vec3* other_left) const {
    SectionMade made;
    TubeEnd& e = made.end;
    e.centre = graph_.places[joint.node];
    e.open = mitred;
    // Along the way, whichever way the joint looks.
    const Vec3 plane = mitred ? joint.normal : way.normal;
    e.normal = plane.dot(way.axis) > 0 ? plane : Vec3(-plane);
    const bool backwards =
        left_of(joint, size.facing, joint.normal).dot(left_of(joint, size.facing, e.normal)) < 0;
    e.left = left_of(joint, size.facing, e.normal);
    const Extents& x = size.extents;
    const double round = (x.left_m + x.right_m) / 2;
    Extents in_plane = backwards ? turned(x, false) : x;
    in_plane.up_m = (1 - joint.steep) * x.up_m + joint.steep * round;
    in_plane.down_m = (1 - joint.steep) * x.down_m + joint.steep * round;
    if (other_left != nullptr && other_left->dot(e.left) < 0) {
      e.left = -e.left;
      in_plane = turned(in_plane, true);
    }
    const std::vector<Vec2> points = points_in(joint, e.normal, e.left, graph_, splays_);
    made.from_splays = points.size() >= kLeastPoints;
    const Outline raw = made.from_splays ? through_points(points, in_plane) : superellipse(in_plane);
    e.outline = at_least(raw, least_m_);
    made.widened = size_of(raw).minCoeff() < least_m_;
    const bool upwards = (end == 0 ? -1 : 1) * e.normal.z() > 0;
    e.cap_m = std::max(0.05, (1 - joint.steep) * size_of(e.outline).minCoeff() / 2 +
                                 joint.steep * (upwards ? x.up_m : x.down_m));
    return made;
  }

 private:
  const PassageGraph& graph_;
  const Splays& splays_;
  double least_m_;
};

}  // namespace

Passages passages_of(const Survey& survey, const SurveyPart& part, const PassageGraph& graph,
                     const Vec3& offset_m, double least_m) {
  const Splays splays = splays_of(survey, graph, offset_m);
  const PassageJoints joined = joints_of(survey, part, graph);
  const SectionSizes sizes = section_sizes(survey, graph, joined, splays);
  Passages made;
  made.measured_half_width_m = sizes.measured_half_width_m;
  made.measured_up_m = sizes.measured_up_m;
  made.measured_down_m = sizes.measured_down_m;

  std::vector<bool> mitred;
  for (const Joint& j : joined.joints) mitred.push_back(is_mitred(j, joined.ways, sizes));
  const std::vector<std::uint32_t> passages = passage_numbers(joined);
  const TubeMaker maker(graph, splays, least_m);
  for (std::uint32_t i = 0; i < joined.ways.size(); ++i) {
    const Way& w = joined.ways[i];
    const std::uint32_t a = w.joint[0], b = w.joint[1];
    const SectionMade from = maker.section(joined.joints[a], sizes.at[a], w, 0, mitred[a], nullptr);
    const SectionMade to = maker.section(joined.joints[b], sizes.at[b], w, 1, mitred[b], &from.end.left);
    made.tubes.emplace_back(from.end, to.end, w.leg, passages[i]);
    GuessedLeg guessed{w.leg, 0, 0};
    for (const auto& [size, section] : {std::pair(&sizes.at[a], &from), std::pair(&sizes.at[b], &to)}) {
      const double half_m = w.length_m / 2;
      if (!size->any) guessed.without_m += half_m;
      if (size->any && !size->all) guessed.partly_m += half_m;
      if (size->standing_in) made.defaults_m += half_m;
      if (section->from_splays) made.splays_m += half_m;
      if (section->widened) made.widened_m += half_m;
      made.sections_from_splays += section->from_splays ? 1u : 0u;
    }
    if (w.steep > 0.5) made.shafts_m += w.length_m;
    if (guessed.without_m + guessed.partly_m > 0) made.guessed.push_back(guessed);
  }
  std::stable_sort(made.tubes.begin(), made.tubes.end(),
                   [](const Tube& a, const Tube& b) { return a.passage() < b.passage(); });
  return made;
}

}  // namespace karst::survey_cave
