#include "sdk/check/cave.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core_stack/common/random.h"

namespace karst::check {
namespace {

using core::Cell;
using core::CellKey;
using core::Vec3;

constexpr float kFree = -2.0f, kOccupied = 2.0f;  // log-odds
constexpr CellKey kFaces[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

}  // namespace

Cave::Cave(std::uint64_t seed, const CaveShape& shape)
    : rock_(core::MapOptions{.resolution_m = shape.resolution_m}),
      map_(core::MapOptions{.resolution_m = shape.resolution_m}),
      frontiers_(core::FrontierOptions{}),
      roadmap_(planning_) {
  dig(seed, shape);
}

/// Each passage is a random walk with drifting direction; its balls of free space are radius / 3 apart.
void Cave::dig(std::uint64_t seed, const CaveShape& shape) {
  core::Random random = core::Random::stream(seed, "cave of a check");
  const double area_m2 = std::numbers::pi * shape.radius_m * shape.radius_m;
  const int passages = shape.branches + 1;
  const double passage_m = std::max(4 * shape.radius_m, shape.volume_m3 / area_m2 / passages);
  for (int p = 0; p < passages; ++p) {
    Ball ball{Vec3(0.05, 0.05, 0.05), shape.radius_m, 0};
    if (p > 0) ball = balls_[static_cast<std::size_t>(random.uniform() * static_cast<double>(balls_.size()))];
    double heading = random.uniform(-std::numbers::pi, std::numbers::pi), slope = random.uniform(-0.3, 0.3);
    const double end_m = ball.path_m + passage_m;
    while (ball.path_m < end_m) {
      balls_.push_back(ball);
      const double step_m = ball.radius_m / 3;
      heading += 0.15 * random.normal();
      slope = std::clamp(slope + 0.05 * random.normal(), -0.5, 0.5);
      ball.center += step_m * Vec3(std::cos(slope) * std::cos(heading), std::cos(slope) * std::sin(heading),
                                   std::sin(slope));
      ball.radius_m = shape.radius_m * (1 + std::clamp(0.15 * random.normal(), -0.3, 0.3));
      ball.path_m += step_m;
    }
    length_m_ = std::max(length_m_, end_m);
  }
  std::stable_sort(balls_.begin(), balls_.end(),
                   [](const Ball& a, const Ball& b) { return a.path_m < b.path_m; });
  for (const Ball& b : balls_)
    for_each_cell(b, [&](const CellKey& k) {
      if (rock_.at(k) == Cell::unknown) rock_.assign(k, 1, kFree);
    });
}

template <class Visit>
void Cave::for_each_cell(const Ball& ball, Visit&& visit) const {
  const CellKey low = rock_.key_of(ball.center - Vec3::Constant(ball.radius_m));
  const CellKey high = rock_.key_of(ball.center + Vec3::Constant(ball.radius_m));
  for (int x = low.x; x <= high.x; ++x)
    for (int y = low.y; y <= high.y; ++y)
      for (int z = low.z; z <= high.z; ++z)
        if ((rock_.center_of({x, y, z}) - ball.center).norm() <= ball.radius_m) visit(CellKey{x, y, z});
}

void Cave::reveal(double path_m) {
  std::vector<core::CellChange> changes;
  const auto know = [&](const CellKey& k, Cell c) {
    if (map_.at(k) != Cell::unknown) return;
    map_.assign(k, 1, c == Cell::free ? kFree : kOccupied);
    changes.push_back({k, Cell::unknown, c});
  };
  for (; revealed_ < balls_.size() && balls_[revealed_].path_m <= path_m; ++revealed_)
    for_each_cell(balls_[revealed_], [&](const CellKey& k) {
      know(k, Cell::free);
      for (const CellKey& face : kFaces)
        if (rock_.at(k + face) == Cell::unknown) know(k + face, Cell::occupied);
    });
  frontiers_.update(map_, changes);
  roadmap_.update(map_, changes);
  viewpoints_.clear();
}

Vec3 Cave::front() const { return revealed_ == 0 ? start() : balls_[revealed_ - 1].center; }

std::vector<core::FrontierOffer> Cave::offers(const core::VehicleDescription& vehicle, const Vec3& from) {
  std::vector<core::FrontierOffer> out;
  std::vector<Vec3> places;
  for (const auto& [id, cluster] : frontiers_.clusters()) {
    auto known = viewpoints_.find(id);
    if (known == viewpoints_.end())
      known = viewpoints_
                  .emplace(id, core::find_viewpoint(map_, cluster, vehicle, planning_.clearance_m, &roadmap_))
                  .first;
    const core::Viewpoint nowhere{Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), 0};
    const core::Viewpoint v = known->second.value_or(nowhere);
    out.push_back({&cluster, v.position, v.heading_rad, std::numeric_limits<double>::infinity()});
    places.push_back(known->second ? v.position : from);
  }
  const std::vector<double> lengths = roadmap_.distances(map_, from, places, 0.5);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i].viewpoint.allFinite()) out[i].path_length_m = lengths[i];
  return out;
}

}  // namespace karst::check
