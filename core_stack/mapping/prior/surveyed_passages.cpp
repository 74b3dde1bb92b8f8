#include "core_stack/mapping/prior/surveyed_passages.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace karst::core {
namespace {

constexpr double kShortestLeg_m = 0.01;  // a shorter one has no direction, and joins its stations only

bool is_size(const PassageSize& s) {
  const auto fine = [](double v) { return std::isfinite(v) && v >= 0; };
  return fine(s.left_m) && fine(s.right_m) && fine(s.up_m) && fine(s.down_m);
}

/// The signed distance to a box of which these are the distances beyond its sides, negative inside.
double box_distance(double x, double y, double z) {
  const Vec3 outside(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0));
  return outside.norm() + std::min(std::max({x, y, z}), 0.0);
}

}  // namespace

bool is_sound(const SurveyPrior& prior) {
  const auto n = prior.stations.size();
  return std::all_of(prior.stations.begin(), prior.stations.end(),
                     [](const Vec3& p) { return p.allFinite(); }) &&
         std::all_of(prior.legs.begin(), prior.legs.end(),
                     [n](const SurveyedLeg& l) {
                       return l.from < n && l.to < n && l.from != l.to && is_size(l.from_size) &&
                              is_size(l.to_size);
                     }) &&
         std::all_of(prior.leads.begin(), prior.leads.end(),
                     [n](const SurveyLead& l) { return l.station < n; });
}

SurveyedPassages::SurveyedPassages(SurveyPrior prior) : prior_(std::move(prior)) {
  add_tubes();
  std::vector<std::uint32_t> order(tubes_.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * order.size());
  if (!order.empty()) add_nodes(order.data(), order.data() + order.size());
}

void SurveyedPassages::add_tubes() {
  std::vector<std::uint32_t> legs_at(prior_.stations.size());
  for (const SurveyedLeg& l : prior_.legs) ++legs_at[l.from], ++legs_at[l.to];
  for (const SurveyedLeg& l : prior_.legs) {
    const Vec3 from = prior_.stations[l.from], to = prior_.stations[l.to];
    const double length_m = (to - from).norm();
    if (length_m < kShortestLeg_m) continue;
    Tube tube;
    tube.from = from;
    tube.length_m = length_m;
    tube.along = (to - from) / length_m;
    const double level = std::hypot(tube.along.x(), tube.along.y()), steep = std::abs(tube.along.z());
    tube.left = level > 1e-6 ? Vec3(-tube.along.y() / level, tube.along.x() / level, 0) : Vec3::UnitY();
    tube.up = tube.along.cross(tube.left);
    const auto end_of = [&](const PassageSize& s, std::uint32_t station) {
      const double half_width_m = 0.5 * (s.left_m + s.right_m), shaft_m = steep * half_width_m;
      return End{s.left_m, s.right_m, level * s.up_m + shaft_m, level * s.down_m + shaft_m,
                 legs_at[station] > 1 ? half_width_m : 0.0};
    };
    tube.at_from = end_of(l.from_size, l.from);
    tube.at_to = end_of(l.to_size, l.to);
    Eigen::AlignedBox3d box;
    const auto extend = [&](const Vec3& end, const End& e) {
      for (const double side : {e.left_m, -e.right_m})
        for (const double height : {e.up_m, -e.down_m}) box.extend(end + side * tube.left + height * tube.up);
    };
    extend(from, tube.at_from);
    extend(from - tube.at_from.beyond_m * tube.along, tube.at_from);
    extend(to, tube.at_to);
    extend(to + tube.at_to.beyond_m * tube.along, tube.at_to);
    tubes_.push_back(tube);
    boxes_.push_back(box);
  }
}

/// Halves the tubes along the longest side of their box, by the middles of their own.
void SurveyedPassages::add_nodes(std::uint32_t* begin, std::uint32_t* end) {
  const std::size_t own = nodes_.size();
  nodes_.emplace_back();
  for (const std::uint32_t* t = begin; t != end; ++t) nodes_[own].box.extend(boxes_[*t]);
  if (end - begin == 1) {
    nodes_[own].tube = *begin;
    return;
  }
  Eigen::Index axis = 0;
  nodes_[own].box.sizes().maxCoeff(&axis);
  std::uint32_t* const middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = boxes_[a].center()[axis], at_b = boxes_[b].center()[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  add_nodes(begin, middle);
  nodes_[own].second = static_cast<std::uint32_t>(nodes_.size());
  add_nodes(middle, end);
}

double SurveyedPassages::Tube::distance_m(const Vec3& p) const {
  const Vec3 from_start = p - from;
  const double s = from_start.dot(along), side = from_start.dot(left), height = from_start.dot(up);
  const double t = std::clamp(s / length_m, 0.0, 1.0);
  const auto between = [t](double a, double b) { return a + t * (b - a); };
  const double across = std::max(side - between(at_from.left_m, at_to.left_m),
                                 -side - between(at_from.right_m, at_to.right_m)),
               vertical = std::max(height - between(at_from.up_m, at_to.up_m),
                                   -height - between(at_from.down_m, at_to.down_m)),
               ends = std::max(-s - at_from.beyond_m, s - length_m - at_to.beyond_m);
  return box_distance(across, vertical, ends);
}

/// A tube is within its box, and its distance nowhere less than the true one: so a box that is farther than
/// the nearest tube so far holds none that is nearer.
double SurveyedPassages::distance_m(const Vec3& p) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return nearest_m;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::uint32_t i = open.back();
    open.pop_back();
    const Node& node = nodes_[i];
    const double away_m = node.box.exteriorDistance(p);
    if (away_m > 0 && away_m >= nearest_m) continue;
    if (node.second == 0) {
      nearest_m = std::min(nearest_m, tubes_[node.tube].distance_m(p));
      continue;
    }
    const bool first_is_nearer =
        nodes_[i + 1].box.squaredExteriorDistance(p) <= nodes_[node.second].box.squaredExteriorDistance(p);
    open.push_back(first_is_nearer ? node.second : i + 1);
    open.push_back(first_is_nearer ? i + 1 : node.second);
  }
  return nearest_m;
}

}  // namespace karst::core
