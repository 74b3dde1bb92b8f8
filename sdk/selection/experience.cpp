#include "sdk/selection/experience.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::selection {
namespace {

using core::InputError;

constexpr std::size_t kSettingsNamed = 4;

/// Converts a policy's parameters to a mission file's form, which has them as text.
boost::property_tree::ptree parameters_of(const std::string& json, const std::string& source,
                                          const std::string& name) {
  boost::property_tree::ptree tree;
  const nlohmann::json j = json.empty() ? nlohmann::json::object() : core::json_of(json);
  if (!j.is_object()) throw InputError(source, name, "its parameters are no JSON object");
  for (const auto& [key, value] : j.items())
    tree.push_back({key, boost::property_tree::ptree(value.is_string() ? value.get<std::string>()
                                                                       : core::json_text(value))});
  return tree;
}

bool has_settings(const campaign::ContestantEntry& c) {
  return !c.settings.empty() && core::json_of(c.settings) != nlohmann::json::object();
}

Fared fared_of(const std::vector<double>& figures) {
  Fared f;
  f.flights = static_cast<int>(figures.size());
  if (figures.empty()) return f;
  double sum = 0, squares = 0;
  for (const double v : figures) sum += v;
  f.mean = sum / static_cast<double>(figures.size());
  for (const double v : figures) squares += (v - f.mean) * (v - f.mean);
  if (figures.size() > 1) f.deviation = std::sqrt(squares / static_cast<double>(figures.size() - 1));
  return f;
}

Experience empty_like(const std::vector<KnownCave>& caves, const std::vector<Preset>& contestants,
                      const Conditions& flown) {
  Experience e{caves, contestants, learned_metrics(), {}, flown};
  e.fared.resize(caves.size() * contestants.size() * e.metrics.size());
  return e;
}

/// All values by key: a key may occur several times (a list of blocks).
std::map<std::string, std::string> by_key(const std::vector<std::pair<std::string, std::string>>& settings) {
  std::map<std::string, std::string> values;
  for (const auto& [key, value] : settings) values[key] += (values.count(key) ? ", " : "") + value;
  return values;
}

std::string text_of(const boost::property_tree::ptree& parameters) {
  std::string text;
  for (const auto& [key, value] : parameters) text += " " + key + "=" + value.data();
  return text;
}

/// The reason why one name denotes two different contestants; "" if it does not.
std::string difference(const Preset& a, const Preset& b) {
  if (a.policy != b.policy) return "policy " + b.policy + " here, " + a.policy + " there";
  if (a.version != b.version) return "version " + b.version + " here, " + a.version + " there";
  if (a.parameters != b.parameters)
    return "parameters" + text_of(b.parameters) + " here," + text_of(a.parameters) + " there";
  return "";
}

}  // namespace

std::string difference(const Conditions& a, const Conditions& b) {
  std::string text;
  const auto differ = [&](const std::string& what, const std::string& there, const std::string& here) {
    text += (text.empty() ? "" : "; ") + what + " " + here + " here, " + there + " there";
  };
  if (a.horizon_s != b.horizon_s)
    differ("horizon", core::json_text(nlohmann::json(a.horizon_s)) + " s",
           core::json_text(nlohmann::json(b.horizon_s)) + " s");
  if (a.profile != b.profile) differ("profile", a.profile, b.profile);
  std::size_t settings = 0;
  const std::map<std::string, std::string> here = by_key(b.mission);
  for (const auto& [key, value] : by_key(a.mission))
    if (const auto same = here.find(key); same != here.end() && same->second != value)
      if (++settings <= kSettingsNamed) differ(key, value, same->second);
  if (settings > kSettingsNamed) text += "; " + std::to_string(settings - kSettingsNamed) + " more settings";
  return text;
}

const std::vector<std::string>& learned_metrics() {
  static const std::vector<std::string> metrics{
      "coverage_auc", "coverage",           "restricted_t50_s",    "restricted_t90_s", "completed",
      "contacts",     "explored_volume_m3", "exploring_speed_mps", "path_length_m",    "energy_wh"};
  return metrics;
}

Experience learn(const campaign::CampaignResults& results, const std::string& source) {
  std::vector<int> cave_of(results.caves.size(), -1), contestant_of(results.contestants.size(), -1);
  std::vector<bool> flown(results.caves.size()), flew(results.contestants.size());
  for (const campaign::TrialResult& t : results.trials) flown[t.cave] = flew[t.contestant] = true;
  std::vector<KnownCave> caves;
  for (std::size_t c = 0; c < results.caves.size(); ++c) {
    const campaign::CaveEntry& cave = results.caves[c];
    if (!flown[c] || cave.description.empty()) continue;
    cave_of[c] = static_cast<int>(caves.size());
    caves.push_back({cave.name, figures_from_json(cave.description, source), cave.hash});
  }
  if (caves.empty()) throw InputError(source, "", "holds no flight through a cave that was described");
  std::vector<Preset> contestants;
  for (std::size_t k = 0; k < results.contestants.size(); ++k) {
    const campaign::ContestantEntry& c = results.contestants[k];
    if (!flew[k] || has_settings(c)) continue;
    contestant_of[k] = static_cast<int>(contestants.size());
    contestants.push_back({c.name, c.policy, c.version, parameters_of(c.parameters, source, c.name)});
  }
  if (contestants.empty())
    throw InputError(source, "", "holds no flight of a policy without settings of its own");
  if (!(results.horizon_s > 0) || results.profile.empty())
    throw InputError(source, "campaign.definition",
                     "does not tell for how long and in which profile it flew");

  Experience e = empty_like(caves, contestants, {results.horizon_s, results.profile, results.shared});
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    const int metric = evaluation::metric_index(e.metrics[m]);
    std::vector<std::vector<double>> figures(contestants.size() * caves.size());
    for (const campaign::TrialResult& t : results.trials) {
      const int k = contestant_of[t.contestant], c = cave_of[t.cave];
      if (k < 0 || c < 0) continue;
      const double v = campaign::figure_of(t, metric, results.horizon_s);
      if (std::isfinite(v))
        figures[static_cast<std::size_t>(k) * caves.size() + static_cast<std::size_t>(c)].push_back(v);
    }
    for (std::size_t k = 0; k < contestants.size(); ++k)
      for (std::size_t c = 0; c < caves.size(); ++c) e.at(k, c, m) = fared_of(figures[k * caves.size() + c]);
  }
  return e;
}

Experience merged(const Experience& a, const Experience& b, const std::string& source) {
  if (const std::string how = difference(a.flown, b.flown); !how.empty())
    throw InputError(source, "",
                     "was flown otherwise than the other results, and figures of such flights do not "
                     "compare: " +
                         how);
  std::vector<KnownCave> caves = a.caves;
  std::vector<Preset> contestants = a.contestants;
  std::vector<std::size_t> cave_of, contestant_of;
  for (const KnownCave& cave : b.caves) {
    const auto same =
        std::find_if(caves.begin(), caves.end(), [&](const KnownCave& c) { return c.name == cave.name; });
    cave_of.push_back(static_cast<std::size_t>(same - caves.begin()));
    if (same == caves.end())
      caves.push_back(cave);
    else if (same->hash != cave.hash || to_json(same->figures) != to_json(cave.figures))
      throw InputError(source, cave.name, "is another cave than the one of the same name in other results");
  }
  for (const Preset& preset : b.contestants) {
    const auto same = std::find_if(contestants.begin(), contestants.end(),
                                   [&](const Preset& p) { return p.name == preset.name; });
    contestant_of.push_back(static_cast<std::size_t>(same - contestants.begin()));
    if (same == contestants.end())
      contestants.push_back(preset);
    else if (const std::string how = difference(*same, preset); !how.empty())
      throw InputError(source, preset.name,
                       "is another contestant than the one of the same name in other results: " + how);
  }
  Experience e = empty_like(caves, contestants, a.flown);
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    for (std::size_t k = 0; k < a.contestants.size(); ++k)
      for (std::size_t c = 0; c < a.caves.size(); ++c) e.at(k, c, m) = a.at(k, c, m);
    for (std::size_t k = 0; k < b.contestants.size(); ++k)
      for (std::size_t c = 0; c < b.caves.size(); ++c) {
        Fared& there = e.at(contestant_of[k], cave_of[c], m);
        if (b.at(k, c, m).flights == 0) continue;
        if (there.flights > 0)
          throw InputError(source, b.contestants[k].name + " in " + b.caves[c].name,
                           "flights of them are in other results as well; they may be the same flights");
        there = b.at(k, c, m);
      }
  }
  return e;
}

Experience without_cave(const Experience& experience, std::size_t cave) {
  std::vector<KnownCave> caves = experience.caves;
  caves.erase(caves.begin() + static_cast<std::ptrdiff_t>(cave));
  Experience e = empty_like(caves, experience.contestants, experience.flown);
  e.source = experience.source;
  for (std::size_t k = 0; k < e.contestants.size(); ++k)
    for (std::size_t c = 0; c < caves.size(); ++c)
      for (std::size_t m = 0; m < e.metrics.size(); ++m) e.at(k, c, m) = experience.at(k, c + (c >= cave), m);
  return e;
}

}  // namespace karst::selection
