#include "sdk/evaluation/metrics/object_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace karst::evaluation {
namespace {

using core::Vec3;
using nlohmann::json;
using Key = std::pair<std::int64_t, std::int64_t>;  // robot, and its own number for the object

constexpr double kSameObject_m = 3;
constexpr double kFarthest_m = 1e6;  // what lies farther is damaged

std::optional<Vec3> position_of(const json& e) {
  const auto p = e.find("position");
  if (p == e.end() || !p->is_array() || p->size() != 3) return std::nullopt;
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    if (!(*p)[static_cast<std::size_t>(i)].is_number()) return std::nullopt;
    v[i] = (*p)[static_cast<std::size_t>(i)].get<double>();
    if (!(std::abs(v[i]) < kFarthest_m)) return std::nullopt;
  }
  return v;
}

/// -1 if it is none.
std::int64_t whole(const json& e, const char* key) {
  const double v = event_number(e, key).value_or(-1);
  return v >= 0 && v <= UINT32_MAX ? static_cast<std::int64_t>(v) : -1;
}

/// By number, as truth_objects.jsonl has them.
std::map<std::int64_t, TrueObject> true_objects(const std::vector<json>& events) {
  std::map<std::int64_t, TrueObject> truth;
  for (const json& e : events) {
    const auto p = position_of(e);
    if (!p || whole(e, "number") < 0) continue;
    TrueObject& o =
        truth.try_emplace(whole(e, "number"), TrueObject{event_text(e, "what"), *p, false}).first->second;
    o.seen = o.seen || event_text(e, "event") == "seen";
  }
  return truth;
}

std::vector<TrueObject> listed(const std::map<std::int64_t, TrueObject>& truth) {
  std::vector<TrueObject> list;
  for (const auto& [number, o] : truth) list.push_back(o);
  return list;
}

/// What events say of objects, as last told; `time` is that of the state that counts as reported.
void note(std::map<Key, KnownObject>& known, const Key& key, const json& e, const char* reported_by) {
  const std::string state = event_text(e, "state");
  if (state == "withdrawn") {
    known.erase(key);
    return;
  }
  KnownObject& o = known[key];
  if (const auto p = position_of(e)) o.what = event_text(e, "what"), o.position = *p;
  if (state == reported_by && !o.reported_s) o.reported_s = event_number(e, "t");
}

std::vector<KnownObject> listed(const std::map<Key, KnownObject>& known) {
  std::vector<KnownObject> list;
  for (const auto& [key, o] : known) list.push_back(o);
  return list;
}

/// Whether a team's log says whose object it is, which, and, unless it is withdrawn, what and where.
bool is_whole_report(const json& e) {
  if (whole(e, "robot") < 0 || whole(e, "number") < 0 || event_text(e, "state").empty()) return false;
  return event_text(e, "state") == "withdrawn" || (position_of(e) && !event_text(e, "what").empty());
}

/// What the base makes of all reports; `at_base` says when each report came. Counts what is damaged.
std::vector<KnownObject> together(const json& e, const std::map<Key, KnownObject>& at_base,
                                  std::size_t& damaged) {
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

std::optional<double> mean(const std::vector<double>& v) {
  if (v.empty()) return std::nullopt;
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

}  // namespace

std::vector<std::optional<std::size_t>> match_objects(const std::vector<KnownObject>& known,
                                                      const std::vector<TrueObject>& truth) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t k = 0; k < known.size(); ++k)
    for (std::size_t t = 0; t < truth.size(); ++t)
      if (const double d = (known[k].position - truth[t].position).norm();
          known[k].what == truth[t].what && d <= kSameObject_m)
        pairs.emplace_back(d, k, t);
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::optional<std::size_t>> match(known.size());
  std::set<std::size_t> taken;
  for (const auto& [d, k, t] : pairs)
    if (!match[k] && taken.insert(t).second) match[k] = t;
  return match;
}

ObjectFigures object_figures(const std::vector<TrueObject>& truth, const std::vector<KnownObject>& found,
                             const std::vector<KnownObject>& at_base) {
  const auto matched = [](const auto& match) {
    return static_cast<double>(
        std::count_if(match.begin(), match.end(), [](const auto& m) { return m.has_value(); }));
  };
  ObjectFigures f;
  f.placed = static_cast<double>(truth.size());
  f.seen = static_cast<double>(
      std::count_if(truth.begin(), truth.end(), [](const TrueObject& o) { return o.seen; }));
  f.found = matched(match_objects(found, truth));
  const auto match = match_objects(at_base, truth);
  f.reported = matched(match);
  f.wrong = static_cast<double>(at_base.size()) - *f.reported;
  std::vector<double> times_s, errors_m;
  double seen_and_reported = 0;
  for (std::size_t k = 0; k < at_base.size(); ++k) {
    if (!match[k]) continue;
    const TrueObject& o = truth[*match[k]];
    seen_and_reported += o.seen;
    errors_m.push_back((at_base[k].position - o.position).norm());
    if (at_base[k].reported_s) times_s.push_back(*at_base[k].reported_s);
  }
  if (*f.seen > 0) f.reported_fraction = seen_and_reported / *f.seen;
  f.report_time_s = mean(times_s);
  f.error_m = mean(errors_m);
  return f;
}

ObjectFigures object_figures(const RunRecord& run) {
  if (run.truth_objects.empty()) return {};
  std::map<Key, KnownObject> known;
  for (const json& e : run.events)
    if (e["kind"] == "object" && whole(e, "number") >= 0) note(known, {0, whole(e, "number")}, e, "reported");
  std::vector<KnownObject> found = listed(known), at_base;
  std::copy_if(found.begin(), found.end(), std::back_inserter(at_base),
               [](const KnownObject& o) { return o.reported_s.has_value(); });
  return object_figures(listed(true_objects(run.truth_objects)), found, at_base);
}

ObjectFigures team_object_figures(const TeamRecord& team, std::vector<std::string>& problems) {
  std::map<std::int64_t, TrueObject> truth;
  for (const RunRecord& robot : team.robots)
    for (const auto& [number, o] : true_objects(robot.truth_objects))
      truth.try_emplace(number, o).first->second.seen |= o.seen;
  std::map<Key, KnownObject> told, at_base;
  std::vector<KnownObject> merged;
  std::size_t damaged = 0;
  for (const json& e : team.events) {
    const std::string kind = event_text(e, "kind");
    const bool one = kind == "object" || kind == "object_known";
    if (one && !is_whole_report(e))
      ++damaged;
    else if (one)
      note(kind == "object" ? told : at_base, {whole(e, "robot"), whole(e, "number")}, e,
           kind == "object" ? "" : "found");
    else if (kind == "objects")
      merged = together(e, at_base, damaged);
  }
  if (damaged > 0)
    problems.push_back("team.jsonl: " + std::to_string(damaged) +
                       " reports of objects are damaged; left out");
  if (truth.empty()) return {};
  return object_figures(listed(truth), listed(told), merged);
}

void set_figures(nlohmann::ordered_json& m, const ObjectFigures& f) {
  const std::array<std::pair<const char*, std::optional<double>>, 8> all{
      {{"objects_placed", f.placed},
       {"objects_seen", f.seen},
       {"objects_found", f.found},
       {"objects_reported", f.reported},
       {"objects_reported_share", f.reported_fraction},
       {"object_report_time_s", f.report_time_s},
       {"object_error_m", f.error_m},
       {"objects_false", f.wrong}}};
  for (const auto& [key, v] : all) {
    m[key] = nullptr;
    if (v) m[key] = std::round(*v * 1e6) / 1e6;
  }
}

}  // namespace karst::evaluation
