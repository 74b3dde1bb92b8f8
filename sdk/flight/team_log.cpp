#include "sdk/flight/team_log.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core_stack/common/error.h"
#include "core_stack/common/json_point.h"
#include "core_stack/common/json_text.h"

namespace karst::flight {

TeamLog::TeamLog(const std::filesystem::path& run_dir) : file_(run_dir / "team.jsonl", std::ios::binary) {
  if (!file_) throw core::InputError((run_dir / "team.jsonl").string(), "", "cannot be written");
}

void TeamLog::event(core::TimeNs t, const std::string& kind, const nlohmann::json& fields) {
  nlohmann::ordered_json line{{"t", core::to_thousandths(core::seconds(t))}, {"kind", kind}};
  for (const auto& [key, value] : fields.items()) line[key] = value;
  file_ << core::json_text(line) << '\n';
}

void TeamLog::base(core::TimeNs t, const core::TeamNode& base) {
  nlohmann::json links = nlohmann::json::array(), held = nlohmann::json::array(),
                 relays = nlohmann::json::array(), dead = nlohmann::json::array();
  for (const core::RelayLink& l : base.graph().links(t))
    links.push_back({l.a, l.b, core::to_thousandths(l.transmissions)});
  for (core::RobotId r = 1; r < core::kMaxRobots; ++r) {
    if (const std::uint32_t n = base.gossip().held(r).first(); n > 0) held.push_back({r, n});
    if (base.reported_dead(r)) dead.push_back(r);
    const auto& landing = base.landing_of(r);
    if (landing && landing->state == core::LandingClaim::State::landed)
      relays.push_back({r, core::rounded_list(landing->ground)});
  }
  event(t, "base",
        {{"connected", base.graph().connected(t)},
         {"links", links},
         {"held", held},
         {"relays", relays},
         {"dead", dead}});
}

void TeamLog::tree(core::TimeNs t, const core::HomingTree& tree) {
  nlohmann::json changed = nlohmann::json::array();
  for (const core::TreeNode& n : tree.nodes()) {
    const std::optional<core::NodeId> next = tree.next(n.id);
    const auto [reported, is_new] = next_.try_emplace(n.id, next);
    if (!is_new && reported->second == next) continue;
    reported->second = next;
    nlohmann::json row{n.id.robot,
                       n.id.number,
                       core::to_thousandths(n.position.x()),
                       core::to_thousandths(n.position.y()),
                       core::to_thousandths(n.position.z()),
                       n.kind == core::NodeKind::communication ? 1 : 0};
    if (next) row.insert(row.end(), {next->robot, next->number});
    changed.push_back(std::move(row));
  }
  if (!changed.empty()) event(t, "tree", {{"nodes", changed}});
}

void TeamLog::traffic(core::TimeNs t, std::size_t radio, const sim::RadioTraffic& r,
                      const core::GossipCounts& c) {
  event(t, "traffic",
        {{"radio", radio},
         {"bytes_sent", r.bytes_sent},
         {"bytes_dropped", r.bytes_dropped},
         {"bytes_heard", r.bytes_heard},
         {"bytes_lost", r.bytes_lost},
         {"bytes_weak", r.bytes_weak},
         {"packets_sent", r.packets_sent},
         {"packets_heard", r.packets_heard},
         {"packets_corrupted", r.packets_corrupted},
         {"frames_refused", std::accumulate(c.refused.begin(), c.refused.end(), std::uint64_t{0})},
         {"records_refused", c.records_refused},
         {"records_taken", c.records_taken}});
}

bool TeamLog::flush() {
  file_.flush();
  return static_cast<bool>(file_);
}

}  // namespace karst::flight
