#include "plugins/simulator/cave_generator/field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plugins/simulator/cave_generator/noise.h"
#include "plugins/simulator/cave_generator/shapes.h"

namespace karst::cave {
namespace {

using core::Vec3;

constexpr double kRockM = 1e3;        // value where nothing is hollow
constexpr double kJoinM = 1.2;        // roundness where two passages meet
constexpr double kSolidJoinM = 0.25;  // where a block lies on the floor
constexpr double kPathJoinM = 0.4;    // where the vehicle's path was cut free

struct Box {
  Vec3 low, high;
};

Box around(const Vec3& center, double radius) {
  return {center - Vec3::Constant(radius), center + Vec3::Constant(radius)};
}

Box box_of(const Segment& s) {
  const Box x = around(s.from.center, s.reach_m), y = around(s.to.center, s.reach_m);
  return {x.low.cwiseMin(y.low), x.high.cwiseMax(y.high)};
}

Box box_of(const Speleothem& s) {
  const Box x = around(s.base, s.base_radius_m), y = around(s.tip, s.base_radius_m);
  return {x.low.cwiseMin(y.low), x.high.cwiseMax(y.high)};
}

}  // namespace

CaveField::CaveField(const CavePlan& plan, double cube_m, double path_radius_m)
    : plan_(plan),
      cube_m_(cube_m),
      path_radius_m_(path_radius_m),
      max_roughness_m_(2 * plan.roughness_m + plan.undulation_m) {
  for (std::size_t i = 0; i < plan.passages.size(); ++i)
    for (std::size_t j = 0; j + 1 < plan.passages[i].size(); ++j) {
      segments_.emplace_back(plan.passages[i][j], plan.passages[i][j + 1]);
      passage_of_.push_back(static_cast<std::int32_t>(i));
    }
  const double margin = max_roughness_m_ + kJoinM;  // what can be added to a shape
  Box all{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity())};
  const auto each_hollow = [&](const auto& visit) {
    for (std::size_t i = 0; i < segments_.size(); ++i)
      visit(box_of(segments_[i]), [i](Cube& c) { c.segments.push_back(static_cast<std::int32_t>(i)); });
    for (std::size_t i = 0; i < plan.chambers.size(); ++i)
      visit(around(plan.chambers[i].center, plan.chambers[i].radii.maxCoeff()),
            [i](Cube& c) { c.chambers.push_back(static_cast<std::int32_t>(i)); });
  };
  each_hollow([&](const Box& b, const auto&) {
    all.low = all.low.cwiseMin(b.low);
    all.high = all.high.cwiseMax(b.high);
  });
  const double spare = margin + 1.5 * cube_m;
  low_ = ((all.low - Vec3::Constant(spare)) / cube_m).array().floor() * cube_m;
  for (int i = 0; i < 3; ++i)
    count_[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>(std::ceil((all.high[i] + spare - low_[i]) / cube_m)) + 1;
  cubes_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  const auto fill = [&](const Box& b, double extra, const auto& put) {
    const Eigen::Array3i first =
        ((b.low - Vec3::Constant(extra) - low_) / cube_m).array().floor().cast<int>().max(0);
    const Eigen::Array3i last =
        ((b.high + Vec3::Constant(extra) - low_) / cube_m).array().floor().cast<int>();
    for (int z = first.z(); z <= std::min(last.z(), count_[2] - 1); ++z)
      for (int y = first.y(); y <= std::min(last.y(), count_[1] - 1); ++y)
        for (int x = first.x(); x <= std::min(last.x(), count_[0] - 1); ++x)
          put(cubes_[(static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x]);
  };
  each_hollow([&](const Box& b, const auto& put) { fill(b, margin, put); });
  for (std::size_t i = 0; i < plan.boulders.size(); ++i)
    fill(around(plan.boulders[i].center, plan.boulders[i].half.norm()), kSolidJoinM + 0.2,
         [i](Cube& c) { c.boulders.push_back(static_cast<std::int32_t>(i)); });
  for (std::size_t i = 0; i < plan.speleothems.size(); ++i)
    fill(box_of(plan.speleothems[i]), kSolidJoinM + 0.2,
         [i](Cube& c) { c.speleothems.push_back(static_cast<std::int32_t>(i)); });
}

const CaveField::Cube& CaveField::cube(std::int32_t x, std::int32_t y, std::int32_t z) const {
  return cubes_[(static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x];
}

CaveField::Smooth CaveField::smooth(const Vec3& p, const Cube& cube) const {
  // Segments of one passage meet without a rounded join: it would widen the passage once a segment.
  double d = kRockM, passage = kRockM, path = kRockM;
  std::int32_t current = -1;
  for (const std::int32_t i : cube.segments) {
    const auto at = static_cast<std::size_t>(i);
    if (passage_of_[at] != current) {
      d = smooth_min(d, passage, kJoinM);
      passage = kRockM;
      current = passage_of_[at];
    }
    const Segment& s = segments_[at];
    const Foot foot = foot_of(p, s);
    const double from_line = foot.offset.norm();
    path = std::min(path, from_line);
    if (from_line - s.reach_m < passage) passage = std::min(passage, segment_distance(foot, s));
  }
  d = smooth_min(d, passage, kJoinM);
  for (const std::int32_t i : cube.chambers)
    d = smooth_min(d, chamber_distance(p, plan_.chambers[static_cast<std::size_t>(i)]), kJoinM);
  return {d, path};
}

double CaveField::roughness(const Vec3& p) const {
  const std::uint32_t s = plan_.noise_seed;
  const double bends = gradient_noise(Vec3(p / 3.1), s) + 0.6 * gradient_noise(Vec3(p / 1.5), s + 1) +
                       0.35 * gradient_noise(Vec3(p / 0.8), s + 2);
  // Beds of limestone weather to ledges: fast variation with height, slow variation along the bed.
  const double beds = 0.3 - std::abs(gradient_noise(Vec3(p.x() / 9, p.y() / 9, p.z() / 1.1), s + 3));
  const double large = 1.8 * gradient_noise(Vec3(p / plan_.undulation_length_m), s + 4) +
                       0.8 * gradient_noise(Vec3(2.1 / plan_.undulation_length_m * p), s + 5);
  return std::clamp(plan_.roughness_m * (1.6 * bends + 1.2 * beds) + plan_.undulation_m * large,
                    -max_roughness_m_, max_roughness_m_);
}

double CaveField::value(const Vec3& p, const Cube& cube) const {
  if (!cube.any()) return kRockM;
  const Smooth s = smooth(p, cube);
  double d = s.hollow;
  if (std::abs(d) < max_roughness_m_ + 1) {  // elsewhere only the sign matters
    const double from_start = (p - plan_.start).norm();
    const double fade = std::clamp((from_start - 2.5) / 3, 0.0, 1.0);  // level ground at the start
    d += fade * roughness(p);
  }
  for (const std::int32_t i : cube.boulders)
    d = -smooth_min(-d, boulder_distance(p, plan_.boulders[static_cast<std::size_t>(i)]), kSolidJoinM);
  for (const std::int32_t i : cube.speleothems)
    d = -smooth_min(-d, speleothem_distance(p, plan_.speleothems[static_cast<std::size_t>(i)]), kSolidJoinM);
  return smooth_min(d, s.path - path_radius_m_, kPathJoinM);
}

double CaveField::value_around(const Vec3& p, double radius_m, const Cube& cube) const {
  if (!cube.any()) return kRockM;
  const Smooth s = smooth(p, cube);
  // The shapes' distance functions grow at most about twice as fast as the true distance.
  const double unsure = 2 * radius_m + max_roughness_m_ + kJoinM;
  if (s.hollow > unsure && s.path - path_radius_m_ > radius_m + kPathJoinM) return s.hollow;
  if (s.hollow < -unsure && !cube.solids()) return s.hollow;
  return 0;
}

double CaveField::value(const Vec3& p) const {
  const Eigen::Array3i c = ((p - low_) / cube_m_).array().floor().cast<int>();
  if ((c < 0).any() || c.x() >= count_[0] || c.y() >= count_[1] || c.z() >= count_[2]) return kRockM;
  return value(p, cube(c.x(), c.y(), c.z()));
}

}  // namespace karst::cave
