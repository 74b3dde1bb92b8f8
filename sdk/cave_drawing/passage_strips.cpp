#include "sdk/cave_drawing/passage_strips.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <set>
#include <utility>

namespace karst::cave_drawing {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct ShortestWays {
  std::vector<double> length_m;
  std::vector<std::uint32_t> before;
};

ShortestWays shortest_ways(const PassageLines& lines) {
  const std::size_t n = lines.points.size();
  ShortestWays ways{std::vector<double>(n, std::numeric_limits<double>::infinity()),
                    std::vector<std::uint32_t>(n, kNone)};
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  ways.length_m[lines.first] = 0;
  open.emplace(0.0, lines.first);
  while (!open.empty()) {
    const auto [length, at] = open.top();
    open.pop();
    if (length > ways.length_m[at]) continue;
    for (const std::uint32_t next : lines.points[at].next) {
      const double to = length + (lines.points[next].middle - lines.points[at].middle).norm();
      if (to >= ways.length_m[next]) continue;
      ways.length_m[next] = to;
      ways.before[next] = at;
      open.emplace(to, next);
    }
  }
  return ways;
}

}  // namespace

std::vector<PassageStrip> passage_strips(const PassageLines& lines) {
  std::vector<PassageStrip> strips;
  if (lines.points.empty()) return strips;
  const ShortestWays ways = shortest_ways(lines);
  std::vector<std::uint32_t> far_first;
  for (std::uint32_t i = 0; i < lines.points.size(); ++i)
    if (ways.before[i] != kNone) far_first.push_back(i);
  std::stable_sort(far_first.begin(), far_first.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return ways.length_m[a] > ways.length_m[b]; });
  std::vector<bool> on_strip(lines.points.size(), false);
  std::set<std::pair<std::uint32_t, std::uint32_t>> used;
  on_strip[lines.first] = true;
  for (const std::uint32_t end : far_first) {
    if (on_strip[end]) continue;
    PassageStrip strip;
    for (std::uint32_t at = end; at != kNone; at = ways.before[at]) {
      strip.points.push_back(at);
      if (on_strip[at]) break;
      on_strip[at] = true;
      used.insert(std::minmax(at, ways.before[at]));
    }
    std::reverse(strip.points.begin(), strip.points.end());
    strips.push_back(std::move(strip));
  }
  if (strips.empty()) strips.push_back({{lines.first}, false});  // a single room
  // What is left closes loops: at the end of the strip that comes there, else on its own.
  for (std::uint32_t i = 0; i < lines.points.size(); ++i)
    for (const std::uint32_t j : lines.points[i].next) {
      if (j < i || used.contains({i, j})) continue;
      used.insert({i, j});
      const auto ends_at = [&](std::uint32_t p) {
        return std::find_if(strips.begin(), strips.end(), [&](const PassageStrip& s) {
          return !s.closes_loop && s.points.size() > 1 && s.points.back() == p;
        });
      };
      if (const auto at_i = ends_at(i); at_i != strips.end())
        at_i->points.push_back(j), at_i->closes_loop = true;
      else if (const auto at_j = ends_at(j); at_j != strips.end())
        at_j->points.push_back(i), at_j->closes_loop = true;
      else
        strips.push_back({{i, j}, true});
    }
  return strips;
}

}  // namespace karst::cave_drawing
