#include "sdk/survey_cave/passages.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sdk/survey/place_sets.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using survey::Section;
using survey::Survey;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A leg with a length, from node to node, and its cross-section's normal.
struct Way {
  std::uint32_t leg = 0;
  std::array<std::uint32_t, 2> node{};
  std::array<std::uint32_t, 2> joint{kNone, kNone};
  Vec3 axis = Vec3::UnitX(), normal = Vec3::UnitX();  // unit, from the first node to the second
  double length_m = 0, steep = 0;                     // steep: 0 gentle, 1 a shaft
};

struct WayEnd {
  std::uint32_t way = 0;
  std::size_t end = 0;
};

/// A cross-section: where one passage goes through a node, or ends there.
struct Joint {
  std::uint32_t node = 0;
  std::vector<WayEnd> ends;     // two, or one
  Vec3 normal = Vec3::UnitX();  // along the way through: in by the first end, out by the second
  Vec3 facing = Vec3::UnitY();  // horizontal; gives left and right where the normal is vertical
  double steep = 0;
  survey::Dimensions measured;    // left as seen along the normal (at a shaft: along `facing`)
  bool own = true;                // measured in this passage, not in another one through the station
  Extents extents;                // measured or guessed
  bool any = false, all = false;  // of the extents are measured
};

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
std::vector<Joint> joints_of(const std::vector<Way>& ways, std::size_t nodes) {
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

bool is_shaft(const Joint& j) { return horizontal(j.normal).norm() < 0.3; }

/// What the sections of its stations tell of a joint: that of its own passage before those of others.
void measure(Joint& joint, const Survey& survey, const std::vector<Way>& ways, const PassageGraph& graph,
             const std::vector<std::vector<const Section*>>& sections) {
  constexpr double kAcross = 0.64;  // cosine of 50 degrees
  const Section* best = nullptr;
  double best_score = -1, best_along = 0;
  bool best_own = true;
  const Vec3 level = horizontal(joint.normal).normalized();
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
  if (best == nullptr) return;
  survey::Dimensions d = best->dimensions;
  drop_empty(d);
  if (std::abs(best_along) < kAcross) d.left_m.reset(), d.right_m.reset();
  if (best_along < 0) std::swap(d.left_m, d.right_m);
  joint.facing = best->facing;
  joint.own = best_own;
  joint.measured = d;
}

/// The left of a section with this normal. A quarter turn from the way ahead, seen from above; where the
/// normal is vertical, from that of the joint, or from the way that its section faces.
Vec3 left_of(const Joint& joint, const Vec3& normal) {
  constexpr double kLevel = 0.1;
  for (const Vec3& ahead : {is_shaft(joint) ? joint.facing : normal, joint.normal, joint.facing}) {
    const Vec3 left = Vec3::UnitZ().cross(ahead), in_plane = left - left.dot(normal) * normal;
    if (in_plane.norm() > kLevel) return in_plane.normalized();
  }
  return normal.unitOrthogonal();
}

/// Splays of the joint's stations in the section's plane: x left, y up. Those that run along the passage more
/// than across it are left out.
std::vector<Vec2> points_in(const Joint& joint, const Vec3& normal, const Vec3& left,
                            const PassageGraph& graph, const std::vector<std::vector<Vec3>>& splays) {
  std::vector<Vec2> points;
  const Vec3 up = normal.cross(left);
  for (const std::uint32_t station : graph.stations[joint.node])
    for (const Vec3& v : splays[station]) {
      const Vec2 p(v.dot(left), v.dot(up));
      if (p.norm() > 0.05 && p.norm() >= std::abs(v.dot(normal))) points.push_back(p);
    }
  return points;
}

constexpr std::size_t kLeastPoints = 4;

/// The extents that splays show, where nothing was noted.
void measure_by(const std::vector<Vec2>& points, Joint& joint) {
  if (points.size() < kLeastPoints) return;
  survey::Dimensions seen;
  const auto grow = [](std::optional<double>& v, double by) { v = std::max(v.value_or(0), by); };
  for (const Vec2& p : points) {
    if (std::abs(p.x()) >= std::abs(p.y())) grow(p.x() > 0 ? seen.left_m : seen.right_m, std::abs(p.x()));
    if (std::abs(p.y()) >= std::abs(p.x())) grow(p.y() > 0 ? seen.up_m : seen.down_m, std::abs(p.y()));
  }
  survey::Dimensions& d = joint.measured;
  if (!joint.own) d = {};
  if (!d.left_m) d.left_m = seen.left_m;
  if (!d.right_m) d.right_m = seen.right_m;
  if (!is_shaft(joint)) {
    if (!d.up_m) d.up_m = seen.up_m;
    if (!d.down_m) d.down_m = seen.down_m;
  }
  joint.own = true;
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

NodeValues values_at_nodes(const std::vector<Joint>& joints, std::size_t nodes) {
  NodeValues values{std::vector<std::optional<double>>(nodes), std::vector<std::optional<double>>(nodes),
                    std::vector<std::optional<double>>(nodes)};
  std::vector<std::array<int, 3>> counts(nodes);
  const auto add = [](std::optional<double>& mean, int& n, double v) {
    mean = (mean.value_or(0) * n + v) / (n + 1);
    ++n;
  };
  for (const Joint& j : joints) {
    if (!j.own) continue;
    const survey::Dimensions& d = j.measured;
    auto& n = counts[j.node];
    if (d.left_m && d.right_m) add(values.half_width[j.node], n[0], (*d.left_m + *d.right_m) / 2);
    if (d.up_m) add(values.up[j.node], n[1], *d.up_m);
    if (d.down_m) add(values.down[j.node], n[2], *d.down_m);
  }
  return values;
}

/// Values where nothing connected was measured: medians, or else a metre.
double or_metre(double median_m) { return median_m > 0 ? median_m : 1; }

struct Filled {
  NodeValues values;       // at every node
  std::vector<bool> none;  // by node: something there is neither measured nor interpolated
};

Filled filled(const PassageGraph& graph, const NodeValues& known, const Passages& medians) {
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

void complete(Joint& joint, const std::vector<Way>& ways, const PassageGraph& graph, const NodeValues& at) {
  const survey::Dimensions& d = joint.measured;
  // A passage that begins at a junction is as large there as at its other end, at most: the station's own
  // dimensions are those of the passage that goes through.
  const bool side = joint.ends.size() == 1 && graph.edges[joint.node].size() >= 3 && !joint.own;
  const std::uint32_t other = ways[joint.ends[0].way].node[1 - joint.ends[0].end];
  const auto guess = [&](const std::vector<std::optional<double>>& values) {
    return side ? std::min(*values[joint.node], *values[other]) : *values[joint.node];
  };
  const auto value = [&](const std::optional<double>& measured,
                         const std::vector<std::optional<double>>& values) {
    if (!measured) return guess(values);
    return side ? std::min(*measured, *values[other]) : *measured;
  };
  joint.extents = {value(d.left_m, at.half_width), value(d.right_m, at.half_width), value(d.up_m, at.up),
                   value(d.down_m, at.down)};
  joint.any = d.any();
  joint.all = !side && d.left_m && d.right_m && d.up_m && d.down_m;
}

double reach_of(const Extents& e) {
  return std::hypot(std::max(e.left_m, e.right_m), std::max(e.up_m, e.down_m));
}

/// Whether the section halves the angle between its two legs: the planes of a leg's ends must not meet within
/// the passage.
bool is_mitred(const Joint& joint, const std::vector<Way>& ways, const std::vector<Joint>& joints) {
  constexpr double kMostTilt = 0.35, kLeastAlong = 0.35;
  if (joint.ends.size() < 2) return false;
  return std::all_of(joint.ends.begin(), joint.ends.end(), [&](const WayEnd& e) {
    const Way& w = ways[e.way];
    const double along = std::abs(joint.normal.dot(w.normal));
    const double reach = std::max(reach_of(joints[w.joint[0]].extents), reach_of(joints[w.joint[1]].extents));
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
  TubeMaker(const PassageGraph& graph, const std::vector<std::vector<Vec3>>& splays, double least_m)
      : graph_(graph), splays_(splays), least_m_(least_m) {}

  /// The section of a joint as an end of a way. `left` of the way's other end, if it is made already, is the
  /// one to agree with.
  SectionMade section(const Joint& joint, const Way& way, std::size_t end, bool mitred,
                      const Vec3* other_left) const {
    SectionMade made;
    TubeEnd& e = made.end;
    e.centre = graph_.places[joint.node];
    e.open = mitred;
    // Along the way, whichever way the joint looks.
    const Vec3 plane = mitred ? joint.normal : way.normal;
    e.normal = plane.dot(way.axis) > 0 ? plane : Vec3(-plane);
    const bool backwards = left_of(joint, joint.normal).dot(left_of(joint, e.normal)) < 0;
    e.left = left_of(joint, e.normal);
    Extents x = joint.extents;
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
  const std::vector<std::vector<Vec3>>& splays_;
  double least_m_;
};

/// By way: the first way of its passage. Ways are joined at joints of two.
std::vector<std::uint32_t> passage_numbers(const std::vector<Joint>& joints, std::size_t ways) {
  survey::PlaceSets passages(ways);
  for (const Joint& j : joints)
    if (j.ends.size() == 2) passages.unite(j.ends[0].way, j.ends[1].way);
  std::vector<std::uint32_t> first(ways, kNone), number;  // first: of a set, by its root
  for (std::uint32_t i = 0; i < ways; ++i) {
    std::uint32_t& lowest = first[passages.root(i)];
    lowest = std::min(lowest, i);
    number.push_back(lowest);
  }
  return number;
}

}  // namespace

Passages passages_of(const Survey& survey, const SurveyPart& part, const PassageGraph& graph,
                     const Vec3& offset_m, double least_m) {
  std::vector<std::vector<const Section*>> sections(survey.stations.size());
  for (const Section& s : survey.sections)
    if (s.dimensions.any()) sections[s.station].push_back(&s);
  std::vector<std::vector<Vec3>> splays(survey.stations.size());
  for (const survey::Splay& s : survey.splays)
    if (const std::uint32_t node = graph.node_of[s.station]; !s.surface && node != kNoNode)
      if (const Vec3 v = s.end_m - offset_m - graph.places[node]; v.allFinite())
        splays[s.station].push_back(v);

  std::vector<Way> ways = ways_of(survey, part, graph);
  std::vector<Joint> joints = joints_of(ways, graph.size());
  Passages made;
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    Joint& j = joints[i];
    for (const WayEnd& e : j.ends) ways[e.way].joint[e.end] = i;
    measure(j, survey, ways, graph, sections);
    measure_by(points_in(j, j.normal, left_of(j, j.normal), graph, splays), j);
  }
  const NodeValues known = values_at_nodes(joints, graph.size());
  made.measured_half_width_m = median_of(known.half_width);
  made.measured_up_m = median_of(known.up);
  made.measured_down_m = median_of(known.down);
  const Filled at = filled(graph, known, made);
  for (Joint& j : joints) complete(j, ways, graph, at.values);

  std::vector<bool> mitred;
  for (const Joint& j : joints) mitred.push_back(is_mitred(j, ways, joints));
  const std::vector<std::uint32_t> passages = passage_numbers(joints, ways.size());
  const TubeMaker maker(graph, splays, least_m);
  for (std::uint32_t i = 0; i < ways.size(); ++i) {
    const Way& w = ways[i];
    const Joint &a = joints[w.joint[0]], &b = joints[w.joint[1]];
    const SectionMade from = maker.section(a, w, 0, mitred[w.joint[0]], nullptr);
    const SectionMade to = maker.section(b, w, 1, mitred[w.joint[1]], &from.end.left);
    made.tubes.emplace_back(from.end, to.end, w.leg, passages[i]);
    GuessedLeg guessed{w.leg, 0, 0};
    for (const auto& [joint, section] : {std::pair(&a, &from), std::pair(&b, &to)}) {
      const double half_m = w.length_m / 2;
      if (!joint->any) guessed.without_m += half_m;
      if (joint->any && !joint->all) guessed.partly_m += half_m;
      if (at.none[joint->node]) made.defaults_m += half_m;
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
