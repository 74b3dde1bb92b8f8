// team.jsonl in the team's run directory: what became of the robots, and what the base knew when.
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
  /// Who reaches the base over which links as it knows, what it holds of whom, and where relays stand.
  void base(core::TimeNs t, const core::TeamNode& base);
  /// The homing tree as the base knows it: nodes that are new, or whose way goes on elsewhere, since the last
  /// call. Writes nothing if there are none.
  void tree(core::TimeNs t, const core::HomingTree& tree);
  void traffic(core::TimeNs t, std::size_t radio, const sim::RadioTraffic& traffic,
               const core::GossipCounts& counts);
  /// False once a write has failed.
  bool flush();

 private:
  std::ofstream file_;
  std::map<core::NodeId, std::optional<core::NodeId>> next_;  // of each node, as last written
};

}  // namespace karst::flight
