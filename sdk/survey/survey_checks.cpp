#include "sdk/survey/survey_checks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"

namespace karst::survey {
namespace {

using core::format_text;

std::string in_parentheses(const Survey& survey, const Source& source) {
  return source.line > 0 ? " (" + place_of(survey, source) + ")" : "";
}

/// Of the first leg of a traverse whose place in the file is known; else none.
Source source_of(const Survey& survey, const Loops::Traverse& traverse) {
  std::map<std::string, std::size_t> at;  // where in the traverse a station is named first
  for (std::size_t i = 0; i < traverse.stations.size(); ++i) at.emplace(traverse.stations[i], i);
  const auto place = [&](std::uint32_t station) {
    const Station& s = survey.stations[station];
    auto found = at.find(s.name);
    for (const std::string& alias : s.aliases)
      if (found == at.end()) found = at.find(alias);
    return found == at.end() ? std::optional<std::size_t>() : found->second;
  };
  Source source;
  std::size_t earliest = traverse.stations.size();
  for (const Leg& leg : survey.legs) {
    if (leg.source.line == 0) continue;
    const auto a = place(leg.from), b = place(leg.to);
    if (!a || !b || std::max(*a, *b) - std::min(*a, *b) != 1 || std::min(*a, *b) >= earliest) continue;
    earliest = std::min(*a, *b);
    source = leg.source;
  }
  return source;
}

std::string ends_of(const Loops::Traverse& traverse) {
  return "from " + core::printable(traverse.from) + " to " + core::printable(traverse.to);
}

void check_loops(const Survey& survey, std::vector<std::string>& checks) {
  const Loops::Traverse* worst = nullptr;
  std::size_t wrong = 0;
  for (const Loops::Traverse& t : survey.loops.traverses) {
    if (t.error_percent <= kWrongLoop_percent ||
        t.sigmas.value_or(kWrongLoop_sigmas + 1) <= kWrongLoop_sigmas)
      continue;
    ++wrong;
    if (worst == nullptr || t.error_percent > worst->error_percent) worst = &t;
  }
  if (worst == nullptr) return;
  std::string text = core::counted(wrong, "traverse") +
                     format_text(" of loops err by more than %g %%; the worst by %.1f %%, %.2f m on %.0f m",
                                 kWrongLoop_percent, worst->error_percent, worst->error_m, worst->length_m);
  if (worst->sigmas) text += format_text(", %.1f standard deviations", *worst->sigmas);
  checks.push_back(text + ", " + ends_of(*worst) + in_parentheses(survey, source_of(survey, *worst)) +
                   ": a reading or an equate is wrong");
}

void check_lengths(const Survey& survey, std::vector<std::string>& checks) {
  const Leg* longest = nullptr;
  double longest_m = kLongLeg_m;
  std::size_t wrong = 0;
  for (const Leg& leg : survey.legs) {
    if (leg.surface) continue;
    const double length_m =
        (survey.stations[leg.from].position_m - survey.stations[leg.to].position_m).norm();
    if (length_m > kLongLeg_m) ++wrong;
    if (length_m <= longest_m) continue;
    longest = &leg;
    longest_m = length_m;
  }
  if (longest == nullptr) return;
  checks.push_back(core::counted(wrong, "leg") +
                   format_text(" longer than %g m; the longest has %.1f m, from ", kLongLeg_m, longest_m) +
                   core::printable(survey.stations[longest->from].name) + " to " +
                   core::printable(survey.stations[longest->to].name) +
                   in_parentheses(survey, longest->source));
}

void check_walls(const Survey& survey, std::vector<std::string>& checks) {
  const Section* farthest = nullptr;
  double farthest_m = kFarWall_m;
  std::size_t wrong = 0;
  for (const Section& s : survey.sections) {
    if (survey.stations[s.station].surface) continue;
    const Dimensions& d = s.dimensions;
    const double most_m = std::max(std::max(d.left_m.value_or(0), d.right_m.value_or(0)),
                                   std::max(d.up_m.value_or(0), d.down_m.value_or(0)));
    if (most_m > kFarWall_m) ++wrong;
    if (most_m <= farthest_m) continue;
    farthest = &s;
    farthest_m = most_m;
  }
  if (farthest == nullptr) return;
  checks.push_back(core::counted(wrong, "section") +
                   format_text(" with a wall more than %g m away; the farthest at %.1f m, seen from ",
                               kFarWall_m, farthest_m) +
                   core::printable(survey.stations[farthest->station].name) +
                   in_parentheses(survey, farthest->source));
}

}  // namespace

std::vector<std::string> survey_checks(const Survey& survey) {
  std::vector<std::string> checks;
  check_loops(survey, checks);
  check_lengths(survey, checks);
  check_walls(survey, checks);
  return checks;
}

void refuse_contradictory_fixes(const Survey& survey) {
  std::set<std::string> fixed;
  for (const Station& s : survey.stations)
    if (s.fixed) {
      fixed.insert(s.name);
      fixed.insert(s.aliases.begin(), s.aliases.end());
    }
  for (const Loops::Traverse& t : survey.loops.traverses) {
    if (!fixed.contains(t.from) || !fixed.contains(t.to) || t.from == t.to) continue;
    if (t.error_m <= kWrongFix_m + kWrongFix * t.length_m) continue;
    if (t.sigmas.value_or(kWrongLoop_sigmas + 1) <= kWrongLoop_sigmas) continue;
    const Source source = source_of(survey, t);
    throw core::InputError(
        survey.files.at(source.file), source.line > 0 ? "line " + std::to_string(source.line) : "",
        format_text(
            "the legs %s, both of them fixed, are %.0f m long, and would have to move by %.0f m: a fix, "
            "an equate or the name of a station is wrong",
            ends_of(t).c_str(), t.length_m, t.error_m));
  }
}

}  // namespace karst::survey
