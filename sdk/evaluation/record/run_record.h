// A run directory read back (docs/run_directory.md). A run that was truncated, or whose files are damaged,
// still gives a record of the readable part; `problems` describes the rest.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/recording/run_event.h"
#include "sdk/evaluation/record/map_growth.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/evaluation/record/table.h"

namespace karst::evaluation {

/// Upper bound of a mission: a day's flight, and a day for a late start and the return. Later times are
/// damaged.
constexpr double kLongestRun_s = 2 * 86400.0;

struct Setting {
  std::string key, value;  // "map.resolution", "0.2 m"
};

struct Phase {
  std::string name;  // a core::Phase's name; for a team "flying"
  double begin_s = 0, end_s = 0;
  bool is(core::Phase phase) const { return name == core::name_of(phase); }
  core::PhaseTraits traits() const {
    const auto phase = core::parse<core::Phase>(name);
    return phase ? core::traits_of(*phase) : core::PhaseTraits{};
  }
};

struct RunRecord {
  std::filesystem::path directory;
  std::vector<Setting> settings;             // mission.info, in its order
  std::vector<nlohmann::json> events;        // in the file's order, none malformed: read with core::event::as
  std::vector<nlohmann::json> truth_events;  // the simulator's: each an object with "time_s" and "event"
  std::vector<nlohmann::json> truth_objects;  // likewise, of objects of interest
  std::vector<StampedPose> estimate, truth;
  std::vector<StampedPose> odometry;  // the estimate before loops were closed; empty if none were
  Table loops;                        // closures of a replay (docs/loops.md); empty without one
  Table telemetry, truth_table, decisions;
  Table unsurveyed;  // what a survey lacks; empty without one
  std::vector<OccupiedSpan> growth;
  nlohmann::json timing;      // null if absent
  nlohmann::json evaluation;  // null if absent
  std::vector<Phase> phases;  // consecutive; "done" is where the last one ends
  std::vector<std::string> problems;

  /// The text of a setting, "" if there is no such key.
  std::string setting(const std::string& key) const;
  /// The leading number of a setting.
  std::optional<double> number(const std::string& key) const;
  double map_resolution_m() const;  // 0.2 if the settings do not contain it
  /// The last event of a kind, such as core::event::Outcome.
  template <class E>
  std::optional<E> last() const {
    for (auto e = events.rbegin(); e != events.rend(); ++e)
      if (auto event = core::event::as<E>(*e)) return event;
    return std::nullopt;
  }
  /// The latest time in the whole record, seconds.
  double last_time_s() const;
};

/// A text field of an untyped line, "" if missing.
std::string event_text(const nlohmann::json& event, const char* key);
/// A number field of an untyped line; none if missing.
std::optional<double> event_number(const nlohmann::json& event, const char* key);

/// The leaves of an INFO file, and the content of a JSON file; empty if the file is missing, and with a
/// problem if it is damaged.
std::vector<Setting> read_settings(const std::filesystem::path& file, std::vector<std::string>& problems);
nlohmann::json read_json(const std::filesystem::path& file, std::vector<std::string>& problems);
/// One JSON object per line, each with a number and a text of the given names; other lines, and those for
/// which `check` throws, are left out and reported.
std::vector<nlohmann::json> read_events(
    const std::filesystem::path& file, const char* time, const char* kind, std::vector<std::string>& problems,
    const std::function<void(const nlohmann::json&)>& check = [](const auto&) {});

/// Throws InputError only if `run_dir` is not a directory.
RunRecord read_run(const std::filesystem::path& run_dir);

/// Only the events, the phases and the problems of these: much faster, for what only the events tell. A
/// folder without events.jsonl has none.
RunRecord read_events_alone(const std::filesystem::path& run_dir);

}  // namespace karst::evaluation
