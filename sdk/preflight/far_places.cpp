#include "sdk/preflight/far_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "sdk/selection/geodesic.h"

namespace karst::preflight {
namespace {

using core::CellKey;
using core::Vec3;
using selection::CellIndex;

constexpr std::size_t kPlaces = 400;

std::size_t nearest_cell(const CellIndex& cells, double edge_m, const Vec3& place) {
  std::size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (const double d = (evaluation::center_of(cells.key(i), edge_m) - place).norm(); d < least_m) {
      least_m = d;
      nearest = i;
    }
  return nearest;
}

/// The neighbour through which the way from the source leads; -1 at the source.
std::int32_t one_nearer(const CellIndex& cells, const std::vector<float>& distance, std::size_t from) {
  std::int32_t best = -1;
  float least = std::numeric_limits<float>::infinity();
  for (int side = 0; side < 27; ++side) {
    const CellKey step{side % 3 - 1, side / 3 % 3 - 1, side / 9 - 1};
    const std::int32_t next = cells.at(cells.key(from) + step);
    if (next < 0) continue;
    const float there = distance[static_cast<std::size_t>(next)];
    const float over =
        there + std::sqrt(static_cast<float>(step.x * step.x + step.y * step.y + step.z * step.z));
    if (there < distance[from] && over < least) {
      least = over;
      best = next;
    }
  }
  return best;
}

std::vector<Vec3> way_to(const CellIndex& cells, const std::vector<float>& distance, double edge_m,
                         std::size_t place) {
  std::vector<Vec3> way{evaluation::center_of(cells.key(place), edge_m)};
  for (std::int32_t at = one_nearer(cells, distance, place); at >= 0;
       at = one_nearer(cells, distance, static_cast<std::size_t>(at)))
    way.push_back(evaluation::center_of(cells.key(static_cast<std::size_t>(at)), edge_m));
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace

FarPlaces far_places(const selection::FreeSpace& space, const Vec3& start, const core::SteepestView& view) {
  FarPlaces out;
  const CellIndex cells(space.flyable);
  if (cells.size() == 0) return out;
  const double edge_m = space.resolution_m;
  const std::size_t source = nearest_cell(cells, edge_m, start);
  const double first_m = (evaluation::center_of(cells.key(source), edge_m) - start).norm();
  const std::vector<float> distance = selection::distances_from(cells, source);
  for (const float d : distance)
    if (std::isfinite(d))
      out.farthest_m = std::max(out.farthest_m, first_m + edge_m * static_cast<double>(d));
  std::size_t places = 0, blind = 0;
  float shortest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < cells.size(); i += std::max<std::size_t>(1, cells.size() / kPlaces)) {
    if (!std::isfinite(distance[i])) continue;
    ++places;
    const std::optional<std::string> why = core::blind_climb(view, {}, way_to(cells, distance, edge_m, i));
    if (!why) continue;
    ++blind;
    if (distance[i] < shortest) {
      shortest = distance[i];
      out.blind_climb = *why;
    }
  }
  if (places > 0) out.blind_fraction = static_cast<double>(blind) / static_cast<double>(places);
  return out;
}

}  // namespace karst::preflight
