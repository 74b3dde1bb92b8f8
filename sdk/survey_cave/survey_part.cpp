#include "sdk/survey_cave/survey_part.h"

#include <algorithm>
#include <functional>
#include <set>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/options.h"
#include "core_stack/common/printable.h"

namespace karst::survey_cave {
namespace {

using core::InputError;
using survey::Leg;
using survey::Station;
using survey::Survey;

/// Whether `part` stands in `whole` between dots or ends.
bool has_words(const std::string& whole, const std::string& part) {
  return ("." + whole + ".").find("." + part + ".") != std::string::npos;
}

template <class Holds>
bool any_name(const Station& s, const Holds& holds) {
  return holds(s.name) || std::any_of(s.aliases.begin(), s.aliases.end(), holds);
}

/// What to try instead: the nearest name, or one of those that there are.
std::string nearest_text(const std::string& name, const std::vector<std::string>& names) {
  const std::string nearest = core::nearest_name(name, names);
  if (!nearest.empty()) return "; the nearest name is " + core::printable(nearest);
  return ", nor one of a name like it; there is, for example, " + core::printable(names.front());
}

std::vector<bool> in_survey(const std::string& file, const Survey& survey, const std::string& name) {
  std::vector<bool> in(survey.stations.size());
  bool found = false;
  for (std::size_t i = 0; i < in.size(); ++i) {
    in[i] = any_name(survey.stations[i], [&](const std::string& s) { return has_words(survey_of(s), name); });
    found |= in[i];
  }
  if (found) return in;
  std::set<std::string> names;
  for (const Station& s : survey.stations)
    for (std::string path = survey_of(s.name); !path.empty(); path = survey_of(path)) {
      names.insert(path);
      names.insert(path.substr(path.rfind('.') + 1));
    }
  if (names.empty()) throw InputError(file, "--survey " + name, "the stations are in no survey");
  throw InputError(file, "--survey " + name,
                   "there is no such survey" + nearest_text(name, {names.begin(), names.end()}));
}

}  // namespace

std::string survey_of(const std::string& station) {
  const std::size_t dot = station.rfind('.');
  return dot == std::string::npos ? "" : station.substr(0, dot);
}

std::uint32_t station_named(const std::string& file, const Survey& survey, const std::string& name) {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t i = 0; i < survey.stations.size(); ++i) {
    const Station& s = survey.stations[i];
    if (any_name(s, [&](const std::string& n) { return n == name; })) return i;
    if (any_name(s, [&](const std::string& n) { return n.ends_with("." + name); })) ends.push_back(i);
  }
  if (ends.size() == 1) return ends.front();
  if (ends.size() > 1)
    throw InputError(
        file, "station " + name,
        core::format_text("%zu stations are named so, such as %s and %s: give the whole name", ends.size(),
                          survey.stations[ends[0]].name.c_str(), survey.stations[ends[1]].name.c_str()));
  std::vector<std::string> names;
  for (const Station& s : survey.stations) names.push_back(s.name);
  if (names.empty()) throw InputError(file, "", "the survey has no station");
  throw InputError(file, "station " + name, "there is no such station" + nearest_text(name, names));
}

SurveyPart part_of(const std::string& file, const Survey& survey, const PartOptions& options) {
  std::vector<bool> in(survey.stations.size(), true);
  if (!options.survey.empty()) in = in_survey(file, survey, options.survey);
  const auto keep = [&](const std::function<bool(const core::Vec3&)>& holds) {
    for (std::size_t i = 0; i < in.size(); ++i) in[i] = in[i] && holds(survey.stations[i].position_m);
  };
  if (!options.around.empty()) {
    const core::Vec3 centre = survey.stations[station_named(file, survey, options.around)].position_m;
    keep([&](const core::Vec3& p) { return (p - centre).norm() <= options.radius_m; });
  }
  if (options.box) keep([&](const core::Vec3& p) { return options.box->contains(p); });

  SurveyPart part;
  std::vector<bool> used(survey.stations.size());
  for (std::uint32_t i = 0; i < survey.legs.size(); ++i) {
    const Leg& leg = survey.legs[i];
    const core::Vec3 &a = survey.stations[leg.from].position_m, &b = survey.stations[leg.to].position_m;
    if (!a.allFinite() || !b.allFinite())
      throw InputError(survey::place_of(survey, leg.source), "", "the leg's stations have no place");
    const double length_m = (a - b).norm();
    if (!leg.surface && !leg.duplicate) part.whole_m += length_m;
    if (!in[leg.from] || !in[leg.to]) continue;
    if (leg.surface) {
      part.surface_m += length_m;
    } else if (leg.duplicate) {
      part.duplicate_m += length_m;
    } else {
      part.legs.push_back(i);
      used[leg.from] = used[leg.to] = true;
    }
  }
  if (part.legs.empty())
    throw InputError(file, "", "no leg is left underground: there is no passage to make");
  for (std::uint32_t i = 0; i < used.size(); ++i)
    if (used[i]) part.stations.push_back(i);
  return part;
}

}  // namespace karst::survey_cave
