#include "sdk/selection/experience.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::selection {
namespace {

using core::InputError;

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

void lay_out(Experience& e, std::vector<Site> sites) {
  e.sites = std::move(sites);
  e.metrics = learned_metrics();
  e.fared.assign(e.sites.size() * e.contestants.size() * e.metrics.size(), {});
}

std::vector<Site> all_sites(const Experience& e) {
  std::vector<Site> sites;
  for (std::size_t q = 0; q < e.conditions.size(); ++q)
    for (std::size_t c = 0; c < e.caves.size(); ++c) sites.push_back({c, q});
  return sites;
}

const std::vector<std::string>& learned_metrics() {
  static const std::vector<std::string> metrics{
      "coverage_auc",    "coverage",           "restricted_t50_s",    "restricted_t90_s", "completed",
      "contacts",        "explored_volume_m3", "exploring_speed_mps", "path_length_m",    "energy_wh",
      "depth_m",         "surface_imaged",     "surface_seen",        "objects_found",    "objects_reported",
      "volume_per_wh_m3"};
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

  Experience e;
  e.caves = std::move(caves);
  e.contestants = std::move(contestants);
  e.conditions.push_back(
      {.horizon_s = results.horizon_s, .profile = results.profile, .mission = results.shared});
  complete(e.conditions.front(), results.flight_time, source);
  lay_out(e, all_sites(e));
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    const int metric = evaluation::metric_index(e.metrics[m]);
    std::vector<std::vector<double>> figures(e.contestants.size() * e.caves.size());
    for (const campaign::TrialResult& t : results.trials) {
      const int k = contestant_of[t.contestant], c = cave_of[t.cave];
      if (k < 0 || c < 0) continue;
      const double v = campaign::figure_of(t, metric, results.horizon_s);
      if (std::isfinite(v))
        figures[static_cast<std::size_t>(k) * e.caves.size() + static_cast<std::size_t>(c)].push_back(v);
    }
    for (std::size_t k = 0; k < e.contestants.size(); ++k)
      for (std::size_t c = 0; c < e.caves.size(); ++c)
        e.at(k, c, m) = fared_of(figures[k * e.caves.size() + c]);
  }
  return e;
}

Experience merged(const Experience& a, const Experience& b, const std::string& source) {
  Experience e;
  e.caves = a.caves;
  e.contestants = a.contestants;
  e.conditions = a.conditions;
  std::vector<std::size_t> cave_of, contestant_of, condition_of;
  for (const Condition& condition : b.conditions) {
    for (const Condition& known : e.conditions)
      if (const std::string how = difference(known, condition); !how.empty())
        throw InputError(source, "",
                         "was flown otherwise than the other results, and figures of such flights do not "
                         "compare: " +
                             how);
    const auto same = std::find_if(e.conditions.begin(), e.conditions.end(),
                                   [&](const Condition& c) { return same_kind(c, condition); });
    condition_of.push_back(static_cast<std::size_t>(same - e.conditions.begin()));
    if (same != e.conditions.end()) continue;
    e.conditions.push_back(condition);
    const auto taken = [&](const std::string& name) {
      return std::any_of(e.conditions.begin(), e.conditions.end() - 1,
                         [&](const Condition& c) { return c.name == name; });
    };
    for (int n = 2; taken(e.conditions.back().name); ++n)
      e.conditions.back().name = condition.name + "_" + std::to_string(n);
  }
  for (const KnownCave& cave : b.caves) {
    const auto same =
        std::find_if(e.caves.begin(), e.caves.end(), [&](const KnownCave& c) { return c.name == cave.name; });
    cave_of.push_back(static_cast<std::size_t>(same - e.caves.begin()));
    if (same == e.caves.end())
      e.caves.push_back(cave);
    else if (same->hash != cave.hash || to_json(same->figures) != to_json(cave.figures))
      throw InputError(source, cave.name, "is another cave than the one of the same name in other results");
  }
  for (const Preset& preset : b.contestants) {
    const auto same = std::find_if(e.contestants.begin(), e.contestants.end(),
                                   [&](const Preset& p) { return p.name == preset.name; });
    contestant_of.push_back(static_cast<std::size_t>(same - e.contestants.begin()));
    if (same == e.contestants.end())
      e.contestants.push_back(preset);
    else if (const std::string how = difference(*same, preset); !how.empty())
      throw InputError(source, preset.name,
                       "is another contestant than the one of the same name in other results: " + how);
  }
  std::vector<Site> sites = a.sites;
  std::vector<std::size_t> site_of;
  for (const Site& s : b.sites) {
    const Site here{cave_of[s.cave], condition_of[s.condition]};
    const auto same = std::find_if(sites.begin(), sites.end(), [&](const Site& t) {
      return t.cave == here.cave && t.condition == here.condition;
    });
    site_of.push_back(static_cast<std::size_t>(same - sites.begin()));
    if (same == sites.end()) sites.push_back(here);
  }
  lay_out(e, std::move(sites));
  for (std::size_t m = 0; m < e.metrics.size(); ++m) {
    for (std::size_t k = 0; k < a.contestants.size(); ++k)
      for (std::size_t s = 0; s < a.sites.size(); ++s) e.at(k, s, m) = a.at(k, s, m);
    for (std::size_t k = 0; k < b.contestants.size(); ++k)
      for (std::size_t s = 0; s < b.sites.size(); ++s) {
        Fared& there = e.at(contestant_of[k], site_of[s], m);
        if (b.at(k, s, m).flights == 0) continue;
        if (there.flights > 0)
          throw InputError(source, b.contestants[k].name + " in " + b.caves[b.sites[s].cave].name,
                           "flights of them are in other results as well; they may be the same flights");
        there = b.at(k, s, m);
      }
  }
  return e;
}

Experience without_cave(const Experience& experience, std::size_t cave) {
  Experience e = experience;
  e.caves.erase(e.caves.begin() + static_cast<std::ptrdiff_t>(cave));
  std::vector<Site> sites;
  std::vector<std::size_t> before;
  for (std::size_t s = 0; s < experience.sites.size(); ++s) {
    const Site site = experience.sites[s];
    if (site.cave == cave) continue;
    sites.push_back({site.cave - (site.cave > cave), site.condition});
    before.push_back(s);
  }
  lay_out(e, std::move(sites));
  for (std::size_t k = 0; k < e.contestants.size(); ++k)
    for (std::size_t s = 0; s < e.sites.size(); ++s)
      for (std::size_t m = 0; m < e.metrics.size(); ++m) e.at(k, s, m) = experience.at(k, before[s], m);
  return e;
}

}  // namespace karst::selection
