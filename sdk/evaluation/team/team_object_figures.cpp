#include "sdk/evaluation/team/team_object_figures.h"

#include <algorithm>

namespace karst::evaluation {
namespace {

using nlohmann::json;

/// A line of a team's log, if it names robot and object and, unless it is withdrawn, kind and position.
std::optional<ObjectReport> report_of(const json& e) {
  const auto state = core::parse<core::ObjectState>(event_text(e, "state"));
  if (whole_number(e, "robot") < 0 || whole_number(e, "number") < 0 || !state) return std::nullopt;
  ObjectReport report{*state, event_text(e, "what"), position_of(e), e["t"]};
  if (*state != core::ObjectState::withdrawn && (!report.position || report.what.empty()))
    return std::nullopt;
  return report;
}

/// The base's merged objects from all reports; `at_base` gives their arrival times. Counts damaged ones.
std::vector<KnownObject> together(const json& e, const KnownObjects& at_base, std::size_t& damaged) {
  std::vector<KnownObject> all;
  const auto known = e.find("known");
  if (known == e.end() || !known->is_array()) return ++damaged, all;
  for (const json& o : *known) {
    const auto p = o.is_object() ? position_of(o) : std::nullopt;
    if (!p || event_text(o, "what").empty()) {
      ++damaged;
      continue;
    }
    KnownObject one{event_text(o, "what"), *p, std::nullopt};
    if (const auto by = o.find("told_by"); by != o.end() && by->is_array())
      for (const json& pair : *by) {
        if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number_integer() ||
            !pair[1].is_number_integer()) {
          ++damaged;
          continue;
        }
        const auto report = at_base.find({pair[0].get<std::int64_t>(), pair[1].get<std::int64_t>()});
        if (report == at_base.end() || !report->second.reported_s) continue;
        one.reported_s =
            std::min(one.reported_s.value_or(*report->second.reported_s), *report->second.reported_s);
      }
    all.push_back(one);
  }
  return all;
}

}  // namespace

ObjectFigures team_object_figures(const TeamRecord& team, std::vector<std::string>& problems) {
  TrueObjects truth;
  for (const RunRecord& robot : team.robots)
    for (const auto& [number, o] : true_objects(robot.truth_objects))
      truth.try_emplace(number, o).first->second.seen |= o.seen;
  KnownObjects told, at_base;
  std::vector<KnownObject> merged;
  std::size_t damaged = 0;
  for (const json& e : team.events) {
    const std::string kind = event_text(e, "kind");
    if (kind == "objects") merged = together(e, at_base, damaged);
    if (kind != "object" && kind != "object_known") continue;
    const KnownObjects::key_type key{whole_number(e, "robot"), whole_number(e, "number")};
    if (const auto report = report_of(e); !report)
      ++damaged;
    else if (kind == "object")
      note(told, key, *report, std::nullopt);
    else
      note(at_base, key, *report, core::ObjectState::found);
  }
  if (damaged > 0)
    problems.push_back("team.jsonl: " + std::to_string(damaged) +
                       " reports of objects are damaged; left out");
  if (truth.empty()) return {};
  return object_figures(listed(truth), listed(told), merged);
}

}  // namespace karst::evaluation
