#include "sdk/survey_cave/section_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace karst::survey_cave {
namespace {

using core::Vec3;
using survey::Section;
using survey::Survey;

/// What the surveyors noted of a joint.
struct Measured {
  Vec3 facing = Vec3::UnitY();
  survey::Dimensions dimensions;  // left as seen along the normal (at a shaft: along `facing`)
  bool own = true;                // measured in this passage, not in another one through the station
};

/// Left and right, or up and down, of nothing are not measured.
void drop_empty(survey::Dimensions& d) {
  constexpr double kNothing_m = 0.05;
  const auto drop = [](std::optional<double>& a, std::optional<double>& b) {
    if (a) a = std::max(*a, 0.0);
    if (b) b = std::max(*b, 0.0);
    if (a.value_or(0) + b.value_or(0) < kNothing_m) a.reset(), b.reset();
  };
  drop(d.left_m, d.right_m);
  drop(d.up_m, d.down_m);
}

/// What the sections of its stations tell of a joint: that of its own passage before those of others.
Measured measured_at(const Joint& joint, const Survey& survey, const std::vector<Way>& ways,
                     const PassageGraph& graph, const std::vector<std::vector<const Section*>>& sections) {
  constexpr double kAcross = 0.64;  // cosine of 50 degrees
  const Section* best = nullptr;
  double best_score = -1, best_along = 0;
  bool best_own = true;
  const Vec3 level = Vec3(joint.normal.x(), joint.normal.y(), 0).normalized();
  for (const std::uint32_t station : graph.stations[joint.node])
    for (const Section* s : sections[station]) {
      const double along = is_shaft(joint) ? 1 : s->facing.dot(level);
      bool own = false, leg = false;
      for (const WayEnd& e : joint.ends) {
        own |= survey.legs[ways[e.way].leg].run == s->run;
        leg |= s->leg == ways[e.way].leg;
      }
      // It is that of another passage only if a leg of that one is here.
      const std::vector<PassageGraph::Edge>& here = graph.edges[joint.node];
      const bool elsewhere = std::any_of(here.begin(), here.end(), [&](const PassageGraph::Edge& e) {
        return survey.legs[e.leg].run == s->run;
      });
      const double score = 4 * own + 2 * leg + std::abs(along);
      if (score <= best_score) continue;
      best_score = score;
      best = s;
      best_along = along;
      best_own = own || leg || !elsewhere;
    }
  if (best == nullptr) return {};
  survey::Dimensions d = best->dimensions;
  drop_empty(d);
  if (std::abs(best_along) < kAcross) d.left_m.reset(), d.right_m.reset();
  if (best_along < 0) std::swap(d.left_m, d.right_m);
  return {best->facing, d, best_own};
}

/// The extents that splays show, where nothing was noted.
void measure_by(const std::vector<Vec2>& points, const Joint& joint, Measured& measured) {
  if (points.size() < kLeastPoints) return;
  survey::Dimensions seen;
  const auto grow = [](std::optional<double>& v, double by) { v = std::max(v.value_or(0), by); };
  for (const Vec2& p : points) {
    if (std::abs(p.x()) >= std::abs(p.y())) grow(p.x() > 0 ? seen.left_m : seen.right_m, std::abs(p.x()));
    if (std::abs(p.y()) >= std::abs(p.x())) grow(p.y() > 0 ? seen.up_m : seen.down_m, std::abs(p.y()));
  }
  survey::Dimensions& d = measured.dimensions;
  if (!measured.own) d = {};
  if (!d.left_m) d.left_m = seen.left_m;
  if (!d.right_m) d.right_m = seen.right_m;
  if (!is_shaft(joint)) {
    if (!d.up_m) d.up_m = seen.up_m;
    if (!d.down_m) d.down_m = seen.down_m;
  }
  measured.own = true;
}

double median_of(std::vector<std::optional<double>> values) {
  std::erase_if(values, [](const auto& v) { return !v; });
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return **middle;
}

/// Values at the nodes: means of what their joints measured.
struct NodeValues {
  std::vector<std::optional<double>> half_width, up, down;
};

NodeValues values_at_nodes(const std::vector<Joint>& joints, const std::vector<Measured>& measured,
                           std::size_t nodes) {
  NodeValues values{std::vector<std::optional<double>>(nodes), std::vector<std::optional<double>>(nodes),
                    std::vector<std::optional<double>>(nodes)};
  std::vector<std::array<int, 3>> counts(nodes);
  const auto add = [](std::optional<double>& mean, int& n, double v) {
    mean = (mean.value_or(0) * n + v) / (n + 1);
    ++n;
  };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!measured[i].own) continue;
    const survey::Dimensions& d = measured[i].dimensions;
    const std::uint32_t node = joints[i].node;
    auto& n = counts[node];
    if (d.left_m && d.right_m) add(values.half_width[node], n[0], (*d.left_m + *d.right_m) / 2);
    if (d.up_m) add(values.up[node], n[1], *d.up_m);
    if (d.down_m) add(values.down[node], n[2], *d.down_m);
  }
  return values;
}

/// Values where nothing connected was measured: medians, or else a metre.
double or_metre(double median_m) { return median_m > 0 ? median_m : 1; }

struct Filled {
  NodeValues values;       // at every node
  std::vector<bool> none;  // by node: something there is neither measured nor interpolated
};

Filled filled(const PassageGraph& graph, const NodeValues& known, const SectionSizes& medians) {
  Filled f{
      {interpolated(graph, known.half_width), interpolated(graph, known.up), interpolated(graph, known.down)},
      std::vector<bool>(graph.size())};
  const auto complete = [&](std::vector<std::optional<double>>& values, double by) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!values[i]) {
        values[i] = by;
        f.none[i] = true;
      }
  };
  complete(f.values.half_width, or_metre(medians.measured_half_width_m));
  complete(f.values.up, or_metre(medians.measured_up_m));
  complete(f.values.down, or_metre(medians.measured_down_m));
  return f;
}

SectionSize completed(const Joint& joint, const Measured& measured, const std::vector<Way>& ways,
                      const PassageGraph& graph, const Filled& at_nodes) {
  const survey::Dimensions& d = measured.dimensions;
  const NodeValues& at = at_nodes.values;
  // A passage that begins at a junction is as large there as at its other end, at most: the station's own
  // dimensions are those of the passage that goes through.
  const bool side = joint.ends.size() == 1 && graph.edges[joint.node].size() >= 3 && !measured.own;
  const std::uint32_t other = ways[joint.ends[0].way].node[1 - joint.ends[0].end];
  const auto guess = [&](const std::vector<std::optional<double>>& values) {
    return side ? std::min(*values[joint.node], *values[other]) : *values[joint.node];
  };
  const auto value = [&](const std::optional<double>& noted,
                         const std::vector<std::optional<double>>& values) {
    if (!noted) return guess(values);
    return side ? std::min(*noted, *values[other]) : *noted;
  };
  SectionSize size;
  size.facing = measured.facing;
  size.extents = {value(d.left_m, at.half_width), value(d.right_m, at.half_width), value(d.up_m, at.up),
                  value(d.down_m, at.down)};
  size.any = d.any();
  size.all = !side && d.left_m && d.right_m && d.up_m && d.down_m;
  size.standing_in = at_nodes.none[joint.node];
  return size;
}

}  // namespace

Splays splays_of(const Survey& survey, const PassageGraph& graph, const Vec3& offset_m) {
  Splays splays(survey.stations.size());
  for (const survey::Splay& s : survey.splays)
    if (const std::uint32_t node = graph.node_of[s.station]; !s.surface && node != kNoNode)
      if (const Vec3 v = s.end_m - offset_m - graph.places[node]; v.allFinite())
        splays[s.station].push_back(v);
  return splays;
}

Vec3 left_of(const Joint& joint, const Vec3& facing, const Vec3& normal) {
  constexpr double kLevel = 0.1;
  for (const Vec3& ahead : {is_shaft(joint) ? facing : normal, joint.normal, facing}) {
    const Vec3 left = Vec3::UnitZ().cross(ahead), in_plane = left - left.dot(normal) * normal;
    if (in_plane.norm() > kLevel) return in_plane.normalized();
  }
  return normal.unitOrthogonal();
}

std::vector<Vec2> points_in(const Joint& joint, const Vec3& normal, const Vec3& left,
                            const PassageGraph& graph, const Splays& splays) {
  std::vector<Vec2> points;
  const Vec3 up = normal.cross(left);
  for (const std::uint32_t station : graph.stations[joint.node])
    for (const Vec3& v : splays[station]) {
      const Vec2 p(v.dot(left), v.dot(up));
      if (p.norm() > 0.05 && p.norm() >= std::abs(v.dot(normal))) points.push_back(p);
    }
  return points;
}

SectionSizes section_sizes(const Survey& survey, const PassageGraph& graph, const PassageJoints& passages,
                           const Splays& splays) {
  std::vector<std::vector<const Section*>> sections(survey.stations.size());
  for (const Section& s : survey.sections)
    if (s.dimensions.any()) sections[s.station].push_back(&s);
  std::vector<Measured> measured;
  for (const Joint& j : passages.joints) {
    Measured& m = measured.emplace_back(measured_at(j, survey, passages.ways, graph, sections));
    measure_by(points_in(j, j.normal, left_of(j, m.facing, j.normal), graph, splays), j, m);
  }
  const NodeValues known = values_at_nodes(passages.joints, measured, graph.size());
  SectionSizes sizes;
  sizes.measured_half_width_m = median_of(known.half_width);
  sizes.measured_up_m = median_of(known.up);
  sizes.measured_down_m = median_of(known.down);
  const Filled at_nodes = filled(graph, known, sizes);
  for (std::size_t i = 0; i < measured.size(); ++i)
    sizes.at.push_back(completed(passages.joints[i], measured[i], passages.ways, graph, at_nodes));
  return sizes;
}

}  // namespace karst::survey_cave
