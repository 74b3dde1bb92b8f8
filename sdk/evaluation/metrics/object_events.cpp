#include "sdk/evaluation/metrics/object_events.h"

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {
namespace {

using core::Vec3;
using nlohmann::json;

constexpr double kFarthest_m = 1e6;  // farther positions are damaged

}  // namespace

std::optional<Vec3> near_enough(const std::optional<Vec3>& p) {
  return p && (p->array().abs() < kFarthest_m).all() ? p : std::nullopt;
}

std::optional<Vec3> position_of(const json& e) {
  const auto p = e.find("position");
  if (p == e.end() || !p->is_array() || p->size() != 3) return std::nullopt;
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    if (!(*p)[static_cast<std::size_t>(i)].is_number()) return std::nullopt;
    v[i] = (*p)[static_cast<std::size_t>(i)].get<double>();
  }
  return near_enough(v);
}

std::int64_t whole_number(const json& e, const char* key) {
  const double v = event_number(e, key).value_or(-1);
  return v >= 0 && v <= UINT32_MAX ? static_cast<std::int64_t>(v) : -1;
}

TrueObjects true_objects(const std::vector<json>& events) {
  TrueObjects truth;
  for (const json& e : events) {
    const auto p = position_of(e);
    if (!p || whole_number(e, "number") < 0) continue;
    TrueObject& o = truth.try_emplace(whole_number(e, "number"), TrueObject{event_text(e, "what"), *p, false})
                        .first->second;
    o.seen = o.seen || event_text(e, "event") == "seen";
  }
  return truth;
}

std::vector<TrueObject> listed(const TrueObjects& truth) {
  std::vector<TrueObject> list;
  for (const auto& [number, o] : truth) list.push_back(o);
  return list;
}

void note(KnownObjects& known, const KnownObjects::key_type& key, const ObjectReport& report,
          std::optional<core::ObjectState> counts_as_reported) {
  if (report.state == core::ObjectState::withdrawn) {
    known.erase(key);
    return;
  }
  KnownObject& o = known[key];
  if (report.position) {
    o.what = report.what;
    o.position = *report.position;
  }
  if (report.state == counts_as_reported && !o.reported_s) o.reported_s = report.t_s;
}

std::vector<KnownObject> listed(const KnownObjects& known) {
  std::vector<KnownObject> list;
  for (const auto& [key, o] : known) list.push_back(o);
  return list;
}

}  // namespace karst::evaluation
