// Definition of a campaign: contestants, caves, seeds, and the mission they share. Example:
//
//   name deeper              ; default: the file's name
//   mission base.info        ; optional: shared settings; all paths are relative to this file
//   profile campaign         ; sdk/campaign/plan/profile.h
//   flight_time "300 s"
//   seeds 30                 ; 1 to 30; or  seed_list "3 5 8"
//   metric coverage_auc      ; the figure that decides the verdict
//   settings { simulator { gust "2 m/s" } }                 ; for all
//   contestant { policy nearest_frontier }
//   contestant { name far  policy nearest_frontier  parameters { horizon "50 m" } }
//   contestant { policy mine  plugin build/mine.so  settings { policy { stream 1 } } }
//   cave { file caves/maze.info }
//   cave { name tunnel  file tunnel.stl  start "1 2 1.5 90" }
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace karst::campaign {

/// Keys of a mission file with their values as text: ("motion.max_speed", "1 m/s").
using Settings = std::vector<std::pair<std::string, std::string>>;

struct ContestantSpec {
  std::string name;  // letters, digits and _-+=.%: folders are named after it
  std::string policy;
  std::string plugin;   // file that is searched first for the policy, or ""
  Settings parameters;  // of the policy
  Settings settings;    // other settings of this contestant alone
};

struct CaveSpec {
  std::string name, file, start;  // start: "" means the cave's own
};

struct Campaign {
  std::string source = "command line";  // where it was read from, for messages
  std::string name = "campaign";
  std::string mission;  // file, or ""
  std::string profile = "campaign";
  double flight_time_s = 300;
  double trial_timeout_s = 7200;  // wall clock; a trial that takes longer counts as hung
  std::vector<std::int64_t> seeds;
  std::string metric = "coverage_auc";  // of evaluation::metric_definitions(): decides the verdict
  Settings settings;
  Settings overrides;  // from the command line; they take precedence over `settings`
  std::vector<ContestantSpec> contestants;
  std::vector<CaveSpec> caves;
};

/// Throws core::InputError with file, place and reason; also if a name is used twice or contestants,
/// caves or seeds are missing. Whether policies and settings exist is checked during planning
/// (plan.h).
Campaign read_campaign(const std::string& file);

/// A contestant in the command line's form: "policy" or "policy:key=value,key=value".
ContestantSpec parse_contestant(const std::string& text);
CaveSpec parse_cave(const std::string& file);

/// Assigns missing names and refuses campaigns that cannot be flown; read_campaign calls it.
void complete(Campaign& campaign);

}  // namespace karst::campaign
