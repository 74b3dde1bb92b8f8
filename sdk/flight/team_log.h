// team.jsonl in the team's run directory: the events of the robots, and the knowledge of the base over time.
// docs/run_directory.md describes it.
#pragma once
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core_stack/common/time.h"
#include "core_stack/homing/path_home/homing_tree.h"
#include "core_stack/team/team_node.h"
#include "plugins/simulator/simulated_world.h"

namespace karst::flight {

class TeamLog {
 public:
  /// Throws core::InputError if the file cannot be made.
  explicit TeamLog(const std::filesystem::path& run_dir);
  /// A line {"t": ..., "kind": kind, ...fields}; t is the team's time.
  void event(core::TimeNs t, const std::string& kind, const nlohmann::json& fields);
  /// The base's knowledge: robots connected to it, links, records held of each robot, and relay positions.
  void base(core::TimeNs t, const core::TeamNode& base);
  /// The homing tree as known to the base: nodes that are new, or whose next node has changed, since the last
  /// call. Writes nothing if there are none.
  void tree(core::TimeNs t, const core::HomingTree& tree);
  void traffic(core::TimeNs t, std::size_t radio, const sim::RadioTraffic& traffic,
               const core::GossipCounts& counts);
  /// False once a write has failed.
  bool flush();

 private:
  std::ofstream file_;
  std::map<core::NodeId, std::optional<core::NodeId>> next_;  // next node of each node, as last written
};

}  // namespace karst::flight
