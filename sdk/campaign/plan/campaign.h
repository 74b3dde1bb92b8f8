// What a campaign is to fly: contestants, caves, seeds, and the mission they share. By example:
//
//   name deeper              ; default: the file's name
//   mission base.info        ; optional: settings they all share, relative to this file as every path here
//   profile campaign         ; sdk/campaign/plan/profile.h
//   flight_time "300 s"
//   seeds 30                 ; 1 to 30; or  seed_list "3 5 8"
//   metric coverage_auc      ; the figure that the verdict is about
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
  std::string plugin;   // file to look for the policy in first, or ""
  Settings parameters;  // of the policy
  Settings settings;    // what else this contestant alone flies with
};

struct CaveSpec {
  std::string name, file, start;  // start: "" is the cave's own
};

struct Campaign {
  std::string source = "command line";  // where it was read, for messages
  std::string name = "campaign";
  std::string mission;  // file, or ""
  std::string profile = "campaign";
  double flight_time_s = 300;
  double trial_timeout_s = 7200;  // of the wall clock; a trial that takes longer hangs
  std::vector<std::int64_t> seeds;
  std::string metric = "coverage_auc";  // of evaluation::metric_definitions(): what the verdict is about
  Settings settings;
  Settings overrides;  // of the command line; they stand above `settings`
  std::vector<ContestantSpec> contestants;
  std::vector<CaveSpec> caves;
};

/// Throws core::InputError naming file, place and reason: also for names that are taken twice, and if it
/// lacks contestants, caves or seeds. Whether policies and settings exist is seen when it is planned
/// (plan.h).
Campaign read_campaign(const std::string& file);

/// A contestant as the command line names it: "policy" or "policy:key=value,key=value".
ContestantSpec parse_contestant(const std::string& text);
CaveSpec parse_cave(const std::string& file);

/// Gives names to what has none, and refuses what cannot be flown; read_campaign does so itself.
void complete(Campaign& campaign);

}  // namespace karst::campaign
