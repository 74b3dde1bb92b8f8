#include "sdk/flight/auto_policy.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/info_lines.h"
#include "core_stack/common/options.h"
#include "core_stack/common/shell_word.h"
#include "sdk/flight/auto_options.h"
#include "sdk/selection/describe.h"
#include "sdk/selection/free_space.h"
#include "sdk/selection/goal.h"
#include "sdk/selection/load_experience.h"
#include "sdk/selection/preset.h"
#include "sdk/selection/select.h"
#include "sdk/selection/select_words.h"
#include "sdk/terminal/terminal.h"

namespace karst::flight {
namespace {

using boost::property_tree::ptree;
using core::InputError;
using selection::Source;

constexpr const char* kOtherwise = "policy.auto.otherwise=";
// Where no experience is at hand: the best on average of the shipped one (docs/results/selection_value.md).
constexpr const char* kBestAsShipped = "deep_cave";

void take(Mission& m, const std::string& policy, const ptree& parameters, const std::string& why) {
  m.policy = policy;
  for (const auto& [key, value] : parameters)  // parameters of the mission itself take precedence
    if (m.policy_parameters.count(key) == 0) m.policy_parameters.push_back({key, value});
  m.policy_selection = why;
}

/// Looks the cave up in the mission's own table; true if it is listed.
bool found_in_table(Mission& m) {
  const std::string name = std::filesystem::path(m.cave).stem().string();
  bool found = false;
  for (const auto& [key, entry] : m.auto_policy) {
    if (key != "cave") continue;
    const std::string where = "policy.auto.cave";
    if (entry.empty())
      throw InputError(m.file, where,
                       "expected a block { name CAVE  policy POLICY }; policy.auto.survey or "
                       "policy.auto.description names a file with what is known of the cave");
    selection::PolicyPreset preset;
    std::string cave, file;
    for (const auto& [field, value] : entry) {
      if (field == "name")
        cave = value.data();
      else if (field == "policy")
        preset.policy = value.data();
      else if (field == "parameters")
        preset.parameters = value;
      else if (field == "preset")
        file = value.data();
      else
        throw InputError(m.file, where + "." + field,
                         "no such key; there are name, policy, parameters, preset");
    }
    if (cave.empty()) throw InputError(m.file, where, "lacks its name");
    if (preset.policy.empty() == file.empty())
      throw InputError(m.file, where + " " + cave, "expected either a policy or a preset");
    if (cave != name) continue;
    if (found) throw InputError(m.file, where + " " + cave, "is there twice");
    if (!file.empty()) preset = selection::read_preset(core::beside(m.file, file));
    take(m, preset.policy, preset.parameters, "the mission's table says so for the cave " + name);
    found = true;
  }
  return found;
}

AutoOptions options_of(const Mission& m) {
  AutoOptions o;
  core::OptionTable table;
  table.under("policy.auto", [&o](core::OptionTable& t) { describe(t, o); });
  ptree rest = m.auto_policy, tree;
  rest.erase("cave");
  tree.put_child("policy.auto", rest);
  if (!rest.empty()) table.read(m.file, tree);
  for (std::string* path : {&o.description, &o.survey, &o.results}) *path = core::beside(m.file, *path);
  return o;
}

/// The settings with which the cave's own mesh counts as a survey: for the user to decide. "" if the file
/// alone does not say how its mesh is to be read.
std::string own_mesh_settings(const Mission& m, const AutoOptions& o) {
  if (m.cave.empty() || m.mesh != core::MeshKeys{}) return "";
  if (m.start.empty() && std::filesystem::path(m.cave).extension() != ".info") return "";
  const auto setting = [](const std::string& text) { return " --set " + core::shell_word(text); };
  return setting("policy.auto.survey=" + m.cave) +
         (m.start.empty() ? "" : setting("policy.auto.survey_start=" + m.start)) +
         (o.otherwise.empty() ? setting(kOtherwise + std::string(kBestAsShipped)) : "");
}

std::string nothing_known(const Mission& m, const AutoOptions& o) {
  const std::string own = own_mesh_settings(m, o);
  return "nothing is known of the cave: give policy.auto.description (figures, or the map of an earlier "
         "flight), policy.auto.survey, or a block policy.auto.cave for it" +
         (own.empty() ? "" : "; to use the cave's own mesh:" + own);
}

selection::CaveFigures known_of(const Mission& m, const AutoOptions& o) {
  if (o.description.empty() == o.survey.empty())
    throw InputError(m.file, "policy.auto",
                     o.survey.empty() ? nothing_known(m, o) : "give a description or a survey, not both");
  if (!o.survey.empty()) {
    if (selection::source_of(o.survey) != Source::mesh)
      throw InputError(m.file, "policy.auto.survey",
                       o.survey + " is no mesh: give it as policy.auto.description");
    return selection::describe_file(o.survey, o.survey_start).figures;
  }
  if (selection::source_of(o.description) == Source::mesh)
    throw InputError(
        m.file, "policy.auto.description",
        o.description + " is the cave itself: if it is known beforehand, give it as policy.auto.survey");
  return selection::describe_file(o.description, "").figures;
}

/// What is known of the cave once a part of it is mapped.
selection::CaveFigures with_part(selection::CaveFigures known, const core::VoxelMap& map) {
  const selection::CaveFigures part = selection::told_by_part(
      selection::describe(selection::free_space_of(map, {}, "the map of this flight")));
  for (const selection::FigureDefinition& f : selection::figure_definitions())
    if (!std::isnan(part.*f.value)) known.*f.value = part.*f.value;
  return known;
}

/// The same selection again, by what the map shows then.
PolicyReview review_of(const Mission& m, const AutoOptions& o, const selection::Experience& e,
                       const selection::CaveFigures& known) {
  return {o.reconsider_s,
          [=, file = m.file, given = m.policy_parameters](
              const core::VoxelMap& map) -> std::pair<std::optional<LaterPolicy>, std::string> {
            try {
              const selection::Selected s = selection::select(e, with_part(known, map), o.select, file);
              if (s.refused) return {std::nullopt, s.reason};
              const selection::Preset& first = e.contestants[s.ranking.front().contestant];
              LaterPolicy later{o.reconsider_s, first.policy, given, s.reason};
              for (const auto& [key, value] : first.parameters)
                if (later.parameters.count(key) == 0) later.parameters.push_back({key, value});
              return {later, s.reason};
            } catch (const InputError& error) {  // in the air the first policy goes on
              return {std::nullopt, error.what()};
            }
          }};
}

}  // namespace

selection::AskedConditions conditions_of(const Mission& m) {
  selection::Condition c;
  c.horizon_s = m.core.mission.max_flight_time_s;
  for (const auto& [key, value] : core::leaves_of(m.resolved)) c.mission.emplace_back(key, value);
  selection::complete(c, m.resolved.get("mission.max_flight_time", ""), m.file);
  return selection::asked(c);
}

void choose_policy(Mission& m) {
  if (m.policy != kAutoPolicy) return;
  AutoOptions o = options_of(m);
  o.select.metric = selection::metric_for(o.select.metric, m.file + ": policy.auto.metric");
  o.select.conditions = conditions_of(m);
  if (found_in_table(m)) return;
  const bool unknown = o.reconsider_s > 0 && o.description.empty() && o.survey.empty();
  if (unknown && (o.otherwise.empty() || o.otherwise == kAutoPolicy))
    throw InputError(m.file, "policy.auto.otherwise",
                     "names the policy until policy.auto.reconsider, as nothing is known of the cave before");
  if (o.reconsider_s > 0 && !o.survey.empty())
    throw InputError(m.file, "policy.auto.reconsider",
                     "is of no use with policy.auto.survey: the survey tells more than the first of a map");
  const selection::CaveFigures figures = unknown ? selection::CaveFigures{} : known_of(m, o);
  const std::string results = o.results.empty() ? selection::installed_experience() : o.results;
  if (results.empty())
    throw InputError(m.file, "policy.auto.results",
                     "no experience is installed: name a store or an experience");
  const selection::Experience e = selection::load_experience(
      {results}, [](const std::string& s) { print_wrapped(stderr, 2, "%s\n", s.c_str()); });
  if (o.reconsider_s > 0) m.review = review_of(m, o, e, figures);
  if (unknown) return take(m, o.otherwise, {}, "otherwise: nothing is known of the cave yet");
  const selection::Selected s =
      selection::select(e, figures, o.select, m.file,
                        o.survey.empty() ? "" : selection::mesh_hash_of(o.survey, o.survey_start));
  if (s.refused) {
    if (o.otherwise.empty() || o.otherwise == kAutoPolicy) {
      const auto best = selection::best_on_average(e, selection::metric_of(e, o.select.metric, m.file),
                                                   o.select.conditions);
      throw InputError(
          m.file, "policy.auto",
          s.reason + "; for such caves policy.auto.otherwise can name a policy: --set " + kOtherwise +
              (best ? e.contestants[best->contestant].policy : kBestAsShipped) +
              (best ? " (" + selection::best_on_average_in_words(e, *best, o.select.metric) + ")" : ""));
    }
    return take(m, o.otherwise, {}, "otherwise: " + s.reason);
  }
  const selection::Preset& first = e.contestants[s.ranking.front().contestant];
  take(m, first.policy, first.parameters, s.reason);
}

}  // namespace karst::flight
