#include "core_stack/team/communication/relay_graph.h"

#include <algorithm>

namespace karst::core {

void describe(OptionTable& t, RelayOptions& o) {
  t.add("link_age", o.link_age_s, "s", 1, 600,
        "what was said of a link longer ago no longer counts; in a team of more than nine radios 1.8 "
        "periods of gossip a radio, if that is longer");
  t.add("min_quality", o.min_quality, "", 0.01, 1, "share of frames that arrive, of what counts as a link");
}

void RelayGraph::note(const TeamState& state) {
  if (state.robot >= kMaxRobots || (stamps_[state.robot] && state.stamp <= *stamps_[state.robot])) return;
  stamps_[state.robot] = state.stamp;
  heard_[state.robot].fill(0);
  for (const RadioContact& h : state.heard)
    if (h.robot < kMaxRobots && h.robot != state.robot) heard_[state.robot][h.robot] = h.quality;
}

bool RelayGraph::fresh(RobotId robot, TimeNs now) const {
  return stamps_[robot] && now - *stamps_[robot] <= from_seconds(options_.link_age_s);
}

std::array<RelayGraph::Row, kMaxRobots> RelayGraph::costs(TimeNs now, double min_quality) const {
  std::array<Row, kMaxRobots> out{};
  for (RobotId a = 0; a < kMaxRobots; ++a)
    for (RobotId b = 0; b < a; ++b) {
      if (!fresh(a, now) || !fresh(b, now)) continue;
      const double there = heard_[a][b], back = heard_[b][a];
      if (std::min(there, back) >= min_quality) out[a][b] = out[b][a] = 1 / (there * back);
    }
  return out;
}

std::vector<RelayLink> RelayGraph::links(TimeNs now) const {
  const auto cost = costs(now, options_.min_quality);
  std::vector<RelayLink> out;
  for (RobotId a = 0; a < kMaxRobots; ++a)
    for (RobotId b = a; b < kMaxRobots; ++b)
      if (cost[a][b] > 0) out.push_back({a, b, cost[a][b]});
  return out;
}

std::vector<RobotId> RelayGraph::connected(TimeNs now) const {
  Robots all;
  all.fill(true);
  return connected(now, all, options_.min_quality);
}

std::vector<RobotId> RelayGraph::connected(TimeNs now, const Robots& relays, double min_quality) const {
  const auto cost = costs(now, min_quality);
  Robots seen{};
  seen[kBase] = true;
  std::vector<RobotId> out{kBase};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] != kBase && !relays[out[i]]) continue;
    for (RobotId to = 0; to < kMaxRobots; ++to)
      if (!seen[to] && cost[out[i]][to] > 0) {
        seen[to] = true;
        out.push_back(to);
      }
  }
  std::sort(out.begin() + 1, out.end());
  return out;
}

bool RelayGraph::reaches_base(TimeNs now, RobotId robot, const Robots& relays, double min_quality) const {
  const std::vector<RobotId> all = connected(now, relays, min_quality);
  return std::find(all.begin(), all.end(), robot) != all.end();
}

}  // namespace karst::core
