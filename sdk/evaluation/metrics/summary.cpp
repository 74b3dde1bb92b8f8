#include "sdk/evaluation/metrics/summary.h"

#include <optional>

#include "core_stack/common/format_text.h"

namespace karst::evaluation {
namespace {

using nlohmann::ordered_json;

std::optional<double> number_of(const ordered_json& metrics, const char* key) {
  const auto found = metrics.find(key);
  if (found == metrics.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string text_of(const ordered_json& metrics, const char* key) {
  const auto found = metrics.find(key);
  return found != metrics.end() && found->is_string() ? found->get<std::string>() : "";
}

/// The number in `format`; "" if it is not known.
std::string part(const char* format, std::optional<double> v) {
  return v ? core::format_text(format, *v) : "";
}

std::string who(const ordered_json& metrics, const Ending& ending) {
  const std::string policy = text_of(metrics, "policy");
  const auto robots = metrics.find("robots");
  const bool team = robots != metrics.end() && robots->is_array();
  if (team) return "a team of " + std::to_string(robots->size()) + (policy.empty() ? "" : " with " + policy);
  if (policy.empty()) return "the vehicle";
  return policy + (ending.failed_policy ? ", and after it failed the fallback," : "");
}

std::string of_replay(const std::string& recording, const ordered_json& metrics) {
  std::string text = recording + part(": %.0f scans", number_of(metrics, "scans"));
  if (const auto lost = number_of(metrics, "scans_lost"); lost && *lost > 0)
    text += part(", %.0f of them lost,", lost);
  text += part(" in %.0f s", number_of(metrics, "flight_time_s"));
  text += part(" along %.1f m", number_of(metrics, "path_length_m"));
  text += part(", %.0f m³ of free volume", number_of(metrics, "explored_volume_m3"));
  const auto closed = number_of(metrics, "loops_closed");
  if (!closed || *closed == 0) return text + ", no loop closed";
  return text + part(*closed == 1 ? ", %.0f loop closed" : ", %.0f loops closed", closed) +
         part(", positions corrected by up to %.2f m", number_of(metrics, "loop_correction_m"));
}

}  // namespace

std::string achievement_of(const ordered_json& metrics, const Ending& ending) {
  if (const std::string recording = text_of(metrics, "recording"); !recording.empty())
    return of_replay(recording, metrics);
  const std::string cave = text_of(metrics, "cave");
  const auto volume_m3 = number_of(metrics, "explored_volume_m3"), coverage = number_of(metrics, "coverage");
  auto time_s = number_of(metrics, "flight_time_s");
  if (const auto team_s = number_of(metrics, "duration_s"))
    time_s = team_s;  // not all robots' times added up
  std::string text = who(metrics, ending);
  if (volume_m3) {
    text += part(" explored %.0f m³", volume_m3) + (cave.empty() ? "" : " of " + cave);
    if (coverage)
      text += part(" (%.1f %% of what can be reached", 100 * *coverage) +
              (text_of(metrics, "coverage_of") == "region" ? " in the region)" : ")");
    text += part(" in %.0f s", time_s);
  } else {
    text += " flew" + (cave.empty() ? "" : " in " + cave) + part(" for %.0f s", time_s);
  }
  if (const auto beyond_m3 = number_of(metrics, "unsurveyed_volume_m3")) {
    text += part(", %.0f m³ beyond the survey", beyond_m3);
    text += part(" (50 m³ after %.0f s)", number_of(metrics, "time_to_unsurveyed_50_s"));
  }
  if (const auto added_m3 = number_of(metrics, "added_volume_m3"))
    text += part(", %.0f m³ of it not in the earlier map", added_m3);
  else if (number_of(metrics, "earlier_map_found"))
    text += ", its place in the earlier map not found";
  const auto clearance_m = number_of(metrics, "min_clearance_m");
  if (clearance_m && *clearance_m > 0) text += part(", %.2f m or more from rock", clearance_m);
  return text;
}

std::string summary_of(const ordered_json& metrics, const Ending& ending) {
  return achievement_of(metrics, ending) + (ending.sentence.empty() ? "" : "; " + ending.sentence);
}

}  // namespace karst::evaluation
