#include "sdk/evaluation/metrics/object_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "core_stack/common/rounded.h"
#include "sdk/evaluation/metrics/object_events.h"

namespace karst::evaluation {
namespace {

using nlohmann::json;

constexpr double kSameObject_m = 3;

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
  KnownObjects known;
  for (const json& e : run.events)
    if (const auto o = core::event::as<core::event::Object>(e))
      note(known, {0, o->number},
           {o->state, o->what ? core::name_of(*o->what) : "", near_enough(o->position), e["t"]},
           core::ObjectState::reported);
  std::vector<KnownObject> found = listed(known), at_base;
  std::copy_if(found.begin(), found.end(), std::back_inserter(at_base),
               [](const KnownObject& o) { return o.reported_s.has_value(); });
  return object_figures(listed(true_objects(run.truth_objects)), found, at_base);
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
    if (v) m[key] = core::to_millionths(*v);
  }
}

}  // namespace karst::evaluation
