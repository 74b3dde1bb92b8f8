#include "core_stack/planning/passages/slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace karst::core {
namespace {

constexpr double kNotReached = std::numeric_limits<double>::infinity();

/// The d with sum over the axes of max(0, d - least)^2 = 1; `least`: the lesser neighbour of each axis.
double upwind(std::array<double, 3> least) {
  std::sort(least.begin(), least.end());  // the same sum however the axes are named
  const double a = least[0], b = least[1] - a, c = least[2] - a;
  if (!(b < 1)) return a + 1;
  const double two = 0.5 * (b + std::sqrt(2 - b * b));
  if (!(c < two)) return a + two;
  const double sum = b + c;
  return a + (sum + std::sqrt(std::max(0.0, sum * sum - 3 * (b * b + c * c - 1)))) / 3;
}

/// For each part the number of links to the nearest one at the border of the space.
std::vector<std::uint32_t> depths_inside(const FreeParts& space) {
  std::vector<std::uint32_t> depth(space.parts.size(), kNoPart), open;
  for (std::uint32_t i = 0; i < depth.size(); ++i) {
    if (space.parts[i].is_inside) continue;
    depth[i] = 0;
    open.push_back(i);
  }
  for (std::size_t at = 0; at < open.size(); ++at)
    for (const PartLink& link : space.links_of(open[at]))
      if (depth[link.part] == kNoPart) {
        depth[link.part] = depth[open[at]] + 1;
        open.push_back(link.part);
      }
  return depth;
}

/// The slice of each part: numbers in the order of their first parts. Returns how many there are.
std::uint32_t number_slices(const FreeParts& space, const std::vector<std::int32_t>& band,
                            std::vector<std::uint32_t>& slice_of) {
  slice_of.assign(space.parts.size(), kNoPart);
  std::uint32_t count = 0;
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < slice_of.size(); ++i) {
    if (slice_of[i] != kNoPart) continue;
    slice_of[i] = count;
    open.assign(1, i);
    while (!open.empty()) {
      const std::uint32_t at = open.back();
      open.pop_back();
      for (const PartLink& link : space.links_of(at))
        if (slice_of[link.part] == kNoPart && band[link.part] == band[at]) {
          slice_of[link.part] = count;
          open.push_back(link.part);
        }
    }
    ++count;
  }
  return count;
}

/// Renumbers the slices by band; those of one band keep their order.
void order_by_band(const std::vector<std::int32_t>& band, std::uint32_t count,
                   std::vector<std::uint32_t>& slice_of) {
  std::vector<std::int32_t> band_of(count);
  for (std::size_t i = 0; i < slice_of.size(); ++i) band_of[slice_of[i]] = band[i];
  std::vector<std::uint32_t> order(count), number(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return band_of[a] < band_of[b]; });
  for (std::uint32_t s = 0; s < count; ++s) number[order[s]] = s;
  for (std::uint32_t& s : slice_of) s = number[s];
}

void choose_middles(const FreeParts& space, Slices& out) {
  std::vector<Vec3> centroid(out.slices.size(), Vec3::Zero());
  for (std::size_t i = 0; i < space.parts.size(); ++i) centroid[out.slice_of[i]] += space.parts[i].middle;
  for (std::size_t s = 0; s < centroid.size(); ++s) centroid[s] /= out.slices[s].parts;
  const std::vector<std::uint32_t> depth = depths_inside(space);
  const auto away = [&](std::uint32_t part) {
    return (space.parts[part].middle - centroid[out.slice_of[part]]).squaredNorm();
  };
  for (std::uint32_t i = 0; i < space.parts.size(); ++i) {
    std::uint32_t& middle = out.slices[out.slice_of[i]].middle;
    if (middle == kNoPart || depth[i] > depth[middle] ||
        (depth[i] == depth[middle] && away(i) < away(middle) - 1e-9))
      middle = i;
  }
}

}  // namespace

std::vector<double> marched(const FreeParts& space) {
  std::vector<double> distance(space.parts.size(), kNotReached);
  if (distance.empty()) return distance;
  std::vector<char> settled(distance.size());
  using Reached = std::pair<double, std::uint32_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  distance[space.start] = 0;
  open.emplace(0.0, space.start);
  while (!open.empty()) {
    const std::uint32_t at = open.top().second;
    open.pop();
    if (settled[at]) continue;
    settled[at] = 1;
    for (const PartLink& link : space.links_of(at)) {
      if (settled[link.part]) continue;
      std::array<double, 3> least{kNotReached, kNotReached, kNotReached};
      for (const PartLink& n : space.links_of(link.part))
        if (settled[n.part]) least[n.axis] = std::min(least[n.axis], distance[n.part]);
      const double d = upwind(least);
      if (d >= distance[link.part]) continue;
      distance[link.part] = d;
      open.emplace(d, link.part);
    }
  }
  return distance;
}

Slices sliced(const FreeParts& space) {
  Slices out;
  out.from_start_cubes = marched(space);
  std::vector<std::int32_t> band(space.parts.size());
  for (std::size_t i = 0; i < band.size(); ++i)
    band[i] = static_cast<std::int32_t>(out.from_start_cubes[i] / kBandCubes);
  const std::uint32_t count = number_slices(space, band, out.slice_of);
  order_by_band(band, count, out.slice_of);
  out.slices.resize(count);
  for (std::uint32_t i = 0; i < space.parts.size(); ++i) {
    Slice& slice = out.slices[out.slice_of[i]];
    slice.band = band[i];
    ++slice.parts;
    slice.free_cells += space.parts[i].free_cells;
    slice.frontier_cells += space.parts[i].frontier_cells;
    for (const PartLink& link : space.links_of(i))
      if (out.slice_of[link.part] != out.slice_of[i]) slice.next.push_back(out.slice_of[link.part]);
  }
  for (Slice& s : out.slices) {
    std::sort(s.next.begin(), s.next.end());
    s.next.erase(std::unique(s.next.begin(), s.next.end()), s.next.end());
  }
  choose_middles(space, out);
  return out;
}

}  // namespace karst::core
