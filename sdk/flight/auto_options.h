// The keys of policy.auto (auto_policy.h): their table is apart, since `karst fly --keys` lists them without
// selecting anything.
#pragma once
#include <string>

#include "core_stack/common/options.h"
#include "sdk/selection/select.h"

namespace karst::flight {

struct AutoOptions {
  std::string description, survey, survey_start, results, otherwise;
  double reconsider_s = 0;
  selection::SelectOptions select;
};

inline void describe(core::OptionTable& t, AutoOptions& o) {
  t.add("description", o.description, {},
        "what is known of the cave: INFO file of figures, or a map of a flight");
  t.add("survey", o.survey, {},
        "a survey of the cave: a mesh, or a cave's .info file; it may be the cave that is flown");
  t.add("survey_start", o.survey_start, {}, "\"x y z\" in the survey, of a mesh");
  t.add("results", o.results, {}, "store of a campaign, or an experience; empty: what is installed");
  t.add("metric", o.select.metric, {}, "the goal, as karst select --for has it, or the figure to do best in");
  t.add(
      "reconsider", o.reconsider_s, "s", 0, 1e6,
      "once, at the first decision at this time of the vehicle's clock, the policy is selected again by what "
      "the map shows then; 0: never");
  t.add("otherwise", o.otherwise, {}, "the policy if nothing similar was flown; empty: no flight");
}

/// A block policy.auto.cave: a choice that is fixed for one cave. Its `parameters` are the policy's own keys.
struct FixedChoice {
  std::string cave, policy, preset;
};

inline void describe(core::OptionTable& t, FixedChoice& c) {
  t.add("name", c.cave, {}, "a cave whose policy is fixed, by its file's name without folder and ending");
  t.add("policy", c.policy, {},
        "the policy for this cave; a block parameters { } beside it holds its parameters");
  t.add("preset", c.preset, {}, "instead: file with a policy and its parameters");
}

}  // namespace karst::flight
