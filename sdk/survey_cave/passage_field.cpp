#include "sdk/survey_cave/passage_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "plugins/simulator/cave_generator/noise.h"
#include "plugins/simulator/cave_generator/shapes.h"

namespace karst::survey_cave {

using core::Vec3;

namespace {

constexpr double kRock_m = 1e3;  // value where no passage is near
constexpr double kJoin_m = 0.4;
/// Cells of the box around the cave: the numbers of blocks then fit into 32 bits along each axis, and into 63
/// bits together.
constexpr double kMostAlong = 2e6;
constexpr std::size_t kMostPairs = 100'000'000;  // of blocks and tubes: 1.6 GB

struct BlockTube {
  std::uint64_t block;  // z, y, x in 21 bits each
  std::uint32_t tube;
  auto operator<=>(const BlockTube&) const = default;
};

std::uint64_t number_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::uint64_t>(z) << 42 | static_cast<std::uint64_t>(y) << 21 |
         static_cast<std::uint64_t>(x);
}

cave::Node corner_of(std::uint64_t block) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const auto at = [&](int shift) {
    return static_cast<std::int32_t>(block >> shift & kMask) * cave::Samples::kEdge;
  };
  return {at(0), at(21), at(42)};
}

Eigen::AlignedBox3d box_of(const Tube& tube, double beyond_m) {
  Eigen::AlignedBox3d box(tube.from().centre);
  box.extend(tube.to().centre);
  const Vec3 reach = Vec3::Constant(tube.reach_m() + beyond_m);
  return {box.min() - reach, box.max() + reach};
}

}  // namespace

PassageField::PassageField(const std::vector<Tube>& tubes, const FieldOptions& options)
    : tubes_(tubes), options_(options), join_m_(kJoin_m) {
  const double block_m = cave::Samples::kEdge * options.grid_m, half_diagonal_m = block_m * std::sqrt(0.75);
  const double margin_m = options.roughness_m + join_m_ + 2 * options.grid_m;
  Eigen::AlignedBox3d all;
  for (const Tube& t : tubes) all.extend(box_of(t, margin_m));
  low_ = (all.min() / block_m).array().floor() * block_m - Vec3::Constant(block_m).array();
  if (((all.max() - low_) / block_m).maxCoeff() > kMostAlong)
    throw std::length_error("the stations lie too far apart");
  std::vector<BlockTube> near;
  for (std::uint32_t i = 0; i < tubes.size(); ++i) {
    // Piece by piece: the box around a long slanting leg holds mostly rock.
    const int pieces = std::max(1, static_cast<int>(std::ceil(tubes[i].length_m() / (4 * block_m))));
    for (int k = 0; k < pieces; ++k) {
      const auto at = [&](int piece) -> Vec3 {
        const Vec3 &a = tubes[i].from().centre, &b = tubes[i].to().centre;
        return a + static_cast<double>(piece) / pieces * (b - a);
      };
      Eigen::AlignedBox3d box(at(k));
      box.extend(at(k + 1));
      const double beyond_m = tubes[i].reach_m() + margin_m;
      const Eigen::Array3i first = (((box.min() - low_).array() - beyond_m) / block_m).floor().cast<int>(),
                           last = (((box.max() - low_).array() + beyond_m) / block_m).floor().cast<int>();
      // Checked before: one passage that is far too wide would fill the memory.
      if ((last - first + 1).cast<double>().prod() > static_cast<double>(kMostPairs))
        throw std::length_error("the passages are too long or too wide");
      for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
          for (int x = first.x(); x <= last.x(); ++x) {
            const Vec3 centre = low_ + block_m * Vec3(x + 0.5, y + 0.5, z + 0.5);
            if (tubes[i].far_distance(centre) <= half_diagonal_m + margin_m)
              near.push_back({number_of(x, y, z), i});
          }
      if (near.size() > kMostPairs) throw std::length_error("the passages are too long or too wide");
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (i == 0 || near[i].block != near[i - 1].block) {
      corners_.push_back(corner_of(near[i].block));
      first_tube_.push_back(static_cast<std::uint32_t>(i));
    }
    block_tubes_.push_back(near[i].tube);
  }
  first_tube_.push_back(static_cast<std::uint32_t>(near.size()));
}

cave::Samples PassageField::sampled() const {
  return {low_, options_.grid_m, corners_,
          [this](std::size_t block, const Vec3& corner, float* values) { fill(block, corner, values); }};
}

void PassageField::fill(std::size_t block, const Vec3& corner, float* values) const {
  const TubeList near(block_tubes_.begin() + first_tube_[block],
                      block_tubes_.begin() + first_tube_[block + 1]);
  fill_part(near, corner, {0, 0, 0}, cave::Samples::kEdge, values);
}

/// Halves the part until it is decided by its middle, or two nodes wide. Values that are told of a whole part
/// have the right sign one step of the grid around it, too: no wall runs between it and the next node.
void PassageField::fill_part(const TubeList& near, const Vec3& corner, const cave::Node& first, int edge,
                             float* values) const {
  const double half_m = 0.5 * (edge - 1) * options_.grid_m;
  const double radius_m = half_m * std::sqrt(3.0) + options_.grid_m + options_.roughness_m;
  const Vec3 middle = corner + options_.grid_m * Vec3(first.x, first.y, first.z) + Vec3::Constant(half_m);
  TubeList left;
  double nearest = kRock_m;
  bool hollow = false;
  for (const std::uint32_t i : near) {
    const double d = tubes_[i].least_distance(middle, radius_m + join_m_);
    if (d > radius_m + join_m_) continue;
    left.push_back(i);
    nearest = std::min(nearest, d);
    hollow = hollow || (d < -radius_m && tubes_[i].holds_ball(middle, radius_m));
    if (hollow) break;
  }
  const bool one_passage = std::all_of(left.begin(), left.end(), [&](std::uint32_t i) {
    return tubes_[i].passage() == tubes_[left.front()].passage();
  });
  const bool solid = left.empty() || (one_passage && nearest > radius_m);
  const auto each = [&](int step, const auto& visit) {
    for (int z = 0; z < edge; z += step)
      for (int y = 0; y < edge; y += step)
        for (int x = 0; x < edge; x += step) visit(first + cave::Node{x, y, z});
  };
  if (hollow || solid) {
    const auto all = static_cast<float>(hollow ? -radius_m : radius_m);
    each(1, [&](const cave::Node& n) { values[cave::Samples::inside(n)] = all; });
  } else if (edge > 2) {
    each(edge / 2, [&](const cave::Node& n) { fill_part(left, corner, n, edge / 2, values); });
  } else {
    each(1, [&](const cave::Node& n) {
      const Vec3 p = corner + options_.grid_m * Vec3(n.x, n.y, n.z);
      values[cave::Samples::inside(n)] = static_cast<float>(value(p, left));
    });
  }
}

Vec3 PassageField::displacement(const Vec3& p) const {
  if (options_.roughness_m <= 0) return Vec3::Zero();
  const double long_m = std::max(2.0, 6 * options_.grid_m), short_m = std::max(0.8, 3 * options_.grid_m);
  Vec3 v;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t seed = options_.noise_seed + 2 * axis;
    v[axis] = 1.5 * cave::gradient_noise(Vec3(p / long_m), seed) +
              0.7 * cave::gradient_noise(Vec3(p / short_m), seed + 1);
  }
  const double norm = v.norm();
  return options_.roughness_m * (norm > 1 ? Vec3(v / norm) : v);
}

double PassageField::value(const Vec3& place, const TubeList& near) const {
  const Vec3 p = place + displacement(place);
  double all = kRock_m, passage = kRock_m;
  std::uint32_t current = tubes_[near.front()].passage();
  for (const std::uint32_t i : near) {
    const Tube& tube = tubes_[i];
    if (tube.passage() != current) {
      // Tubes of one passage meet without a rounded edge: it would widen the passage once a leg.
      all = cave::smooth_min(all, passage, join_m_);
      passage = kRock_m;
      current = tube.passage();
    }
    if (tube.far_distance(p) < passage) passage = std::min(passage, tube.distance(p));
  }
  return cave::smooth_min(all, passage, join_m_);
}

}  // namespace karst::survey_cave
