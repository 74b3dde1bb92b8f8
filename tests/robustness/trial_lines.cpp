#include "tests/robustness/trial_lines.h"

#include <map>
#include <nlohmann/json.hpp>

#include "core_stack/common/json_text.h"
#include "core_stack/common/rounded.h"
#include "sdk/evaluation/record/lines.h"

namespace karst::robustness {
namespace {

using core::to_thousandths;
using nlohmann::json;
using nlohmann::ordered_json;

}  // namespace

TrialLine line_of(const Trial& t, const Verdict& verdict, const host::ProcessEnd& end,
                  const std::string& build) {
  const bool breaks = t.fault == Fault::policy_crash || t.fault == Fault::policy_hang;
  return {t.number,
          build,
          t.cave.kind,
          t.cave_name(),
          breaks ? "breaks_later" : t.policy,
          t.vehicle,
          name_of(t.fault),
          t.fault_text(),
          verdict,
          end.exit_code,
          end.wall_s};
}

std::string to_json(const TrialLine& l) {
  ordered_json j;
  j["trial"] = l.trial;
  j["build"] = l.build;
  j["kind"] = l.cave_kind;
  j["cave"] = l.cave;
  j["policy"] = l.policy;
  j["vehicle"] = l.vehicle;
  j["fault"] = l.fault;
  j["what"] = l.fault_text;
  j["outcome"] = name_of(l.verdict.outcome);
  j["least_clearance_m"] = l.verdict.least_clearance_m
                               ? ordered_json(to_thousandths(*l.verdict.least_clearance_m))
                               : ordered_json();
  j["stall_s"] = to_thousandths(l.verdict.stall_s);
  j["in_air_s"] = to_thousandths(l.verdict.in_air_s);
  j["exit"] = l.exit_code;
  j["wall_s"] = to_thousandths(l.wall_s);
  j["reason"] = l.verdict.reason;
  return core::json_text(j);
}

std::optional<TrialLine> from_json(const std::string& text) {
  const json j = json::parse(text, nullptr, false);
  try {
    TrialLine l{j.at("trial"), j.at("build"), j.at("kind"), j.at("cave"), j.at("policy"), j.at("vehicle"),
                j.at("fault"), j.at("what"),  {},           j.at("exit"), j.at("wall_s")};
    const std::string outcome = j.at("outcome");
    for (const Outcome o : kOutcomes)
      if (outcome == name_of(o)) l.verdict.outcome = o;
    if (j.at("least_clearance_m").is_number()) l.verdict.least_clearance_m = j.at("least_clearance_m");
    l.verdict.stall_s = j.at("stall_s");
    l.verdict.in_air_s = j.at("in_air_s");
    l.verdict.reason = j.at("reason");
    return l;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::vector<TrialLine> read_trials(const std::filesystem::path& file) {
  std::vector<std::string> problems;
  std::map<int, TrialLine> by_trial;
  for (const std::string& text : evaluation::read_lines(file, problems))
    if (const auto line = from_json(text)) by_trial[line->trial] = *line;
  std::vector<TrialLine> lines;
  for (const auto& [trial, line] : by_trial) lines.push_back(line);
  return lines;
}

}  // namespace karst::robustness
