#include "core_stack/homing/relay_graph.h"

#include <algorithm>
#include <limits>

namespace karst::core {

void describe(OptionTable& t, RelayOptions& o) {
  t.add("link_age", o.link_age_s, "s", 1, 600, "what was said of a link longer ago no longer counts");
  t.add("least_quality", o.least_quality, "", 0.01, 1,
        "share of frames that arrive, of what counts as a link");
}

void RelayGraph::note(const TeamState& state) {
  if (state.robot >= kMostRobots || (stamps_[state.robot] && state.stamp <= *stamps_[state.robot])) return;
  stamps_[state.robot] = state.stamp;
  heard_[state.robot].fill(0);
  for (const HeardRobot& h : state.heard)
    if (h.robot < kMostRobots && h.robot != state.robot) heard_[state.robot][h.robot] = h.quality;
}

bool RelayGraph::fresh(RobotId robot, TimeNs now) const {
  return stamps_[robot] && now - *stamps_[robot] <= from_seconds(options_.link_age_s);
}

std::array<RelayGraph::Row, kMostRobots> RelayGraph::costs(TimeNs now) const {
  std::array<Row, kMostRobots> out{};
  for (RobotId a = 0; a < kMostRobots; ++a)
    for (RobotId b = 0; b < a; ++b) {
      if (!fresh(a, now) || !fresh(b, now)) continue;
      const double there = heard_[a][b], back = heard_[b][a];
      if (std::min(there, back) >= options_.least_quality) out[a][b] = out[b][a] = 1 / (there * back);
    }
  return out;
}

std::vector<RelayLink> RelayGraph::links(TimeNs now) const {
  const auto cost = costs(now);
  std::vector<RelayLink> out;
  for (RobotId a = 0; a < kMostRobots; ++a)
    for (RobotId b = a; b < kMostRobots; ++b)
      if (cost[a][b] > 0) out.push_back({a, b, cost[a][b]});
  return out;
}

std::vector<RobotId> RelayGraph::connected(TimeNs now, RobotId from,
                                           const std::vector<RobotId>& without) const {
  const auto cost = costs(now);
  std::array<bool, kMostRobots> seen{};
  for (const RobotId r : without) seen[r] = true;
  if (seen[from]) return {};
  seen[from] = true;
  std::vector<RobotId> out{from};
  for (std::size_t i = 0; i < out.size(); ++i)
    for (RobotId to = 0; to < kMostRobots; ++to)
      if (!seen[to] && cost[out[i]][to] > 0) seen[to] = true, out.push_back(to);
  std::sort(out.begin() + 1, out.end());
  return out;
}

bool RelayGraph::reaches_base(TimeNs now, RobotId robot) const {
  const std::vector<RobotId> all = connected(now);
  return std::find(all.begin(), all.end(), robot) != all.end();
}

std::optional<RobotId> RelayGraph::next_hop(TimeNs now, RobotId from) const {
  const auto cost = costs(now);
  // Dijkstra's algorithm from the base; with sixteen nodes a heap would be slower.
  Row to_base;
  to_base.fill(std::numeric_limits<double>::infinity());
  to_base[kBase] = 0;
  std::array<bool, kMostRobots> done{};
  for (RobotId round = 0; round < kMostRobots; ++round) {
    RobotId best = kMostRobots;
    for (RobotId i = 0; i < kMostRobots; ++i)
      if (!done[i] && (best == kMostRobots || to_base[i] < to_base[best])) best = i;
    done[best] = true;
    for (RobotId i = 0; i < kMostRobots; ++i)
      if (cost[best][i] > 0) to_base[i] = std::min(to_base[i], to_base[best] + cost[best][i]);
  }
  if (from == kBase || to_base[from] == std::numeric_limits<double>::infinity()) return std::nullopt;
  RobotId hop = kMostRobots;
  for (RobotId i = 0; i < kMostRobots; ++i)
    if (cost[from][i] > 0 &&
        (hop == kMostRobots || cost[from][i] + to_base[i] < cost[from][hop] + to_base[hop]))
      hop = i;
  return hop;
}

std::vector<RobotId> RelayGraph::lost_without(TimeNs now, RobotId relay) const {
  const std::vector<RobotId> with = connected(now), left = connected(now, kBase, {relay});
  std::vector<RobotId> out;
  for (const RobotId r : with)
    if (r != relay && std::find(left.begin(), left.end(), r) == left.end()) out.push_back(r);
  return out;
}

std::vector<RobotId> RelayGraph::indispensable(TimeNs now) const {
  std::vector<RobotId> out;
  for (const RobotId r : connected(now))
    if (r != kBase && !lost_without(now, r).empty()) out.push_back(r);
  return out;
}

bool RelayGraph::survives_any_loss(TimeNs now, const std::vector<RobotId>& neighbours) const {
  const auto reached_without = [&](const std::vector<RobotId>& lost) {
    const std::vector<RobotId> left = connected(now, kBase, lost);
    return std::any_of(neighbours.begin(), neighbours.end(),
                       [&left](RobotId r) { return std::find(left.begin(), left.end(), r) != left.end(); });
  };
  if (!reached_without({})) return false;
  for (RobotId r = 1; r < kMostRobots; ++r)
    if (!reached_without({r})) return false;
  return true;
}

}  // namespace karst::core
