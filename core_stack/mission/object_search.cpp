#include "core_stack/mission/object_search.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/common/json_point.h"
#include "core_stack/mission/recording/object_log.h"

namespace karst::core {
namespace {

constexpr std::uint32_t kReported = 0;  // takes the place of a record's number, which is at least 1

}  // namespace

void ObjectSearch::on_objects(const ObjectDetections& look) {
  if (look.stamp > onboard_.now() || !look.camera) return;
  const auto& known = onboard_.flight.estimator().history().states();
  if (known.empty() ||
      look.stamp < known.front().stamp) {  // the camera's pose at that time is no longer known
    if (!std::exchange(late_looks_reported_, true))
      onboard_.recorder.write(onboard_.now(),
                              event::Log{"the object detector is too slow: its news is dropped"});
    return;
  }
  const Pose T_world_camera =
      onboard_.flight.estimator().history().pose_at(look.stamp) * look.camera->T_body_camera;
  objects_.note(look, T_world_camera, onboard_.flight.estimator().active().position_sigma_m());
  report(Report::what_changed);
}

/// Reports to the events and to the team.
void ObjectSearch::report(Report which) {
  for (const ObjectNews& news : objects_.take_news(onboard_.now(), which == Report::all)) {
    const FoundObject& o = news.object;
    const bool withdrawn = news.state == ObjectState::withdrawn;
    onboard_.recorder.write(
        onboard_.now(), event::Object{news.state, o.number, o.kind, o.position, o.deviation_m, o.sightings});
    if (!team_) continue;
    const ObjectKind kind = withdrawn ? ObjectKind::none : o.kind;
    const std::uint32_t record =
        team_->publish(ObjectSeen{team_->team_time(onboard_.now()), o.number, static_cast<std::uint8_t>(kind),
                                  o.position, o.deviation_m});
    if (withdrawn)
      records_.erase(o.number);
    else if (record != 0)
      records_.try_emplace(o.number, record);  // the first record: with it the base knows the object
  }
}

/// Records, once per object, that the base is known to have it.
void ObjectSearch::note_at_base() {
  const std::uint32_t known = team_->known_at_base();
  for (auto& [number, record] : records_) {
    if (record == kReported || record > known) continue;
    onboard_.recorder.write(onboard_.now(), event::Object{.state = ObjectState::reported, .number = number});
    record = kReported;
  }
}

/// Ends the search. A vehicle that flies alone reports where it landed, at the start. In a team, a vehicle
/// that has crashed reports nothing more.
void ObjectSearch::finish(bool landed) {
  if (team_ && !landed) return;
  report(Report::all);
  if (team_) return note_at_base();
  if (!landed) return;
  for (const FoundObject& o : objects_.objects())
    onboard_.recorder.write(onboard_.now(),
                            event::Object{.state = ObjectState::reported, .number = o.number});
}

void ObjectSearch::write() const {
  nlohmann::json found = nlohmann::json::array();
  for (const FoundObject& o : objects_.objects())
    found.push_back({{"number", o.number},
                     {"what", core::name_of(o.kind)},
                     {"position", list(o.position)},
                     {"deviation", o.deviation_m},
                     {"sightings", o.sightings},
                     {"first_seen", seconds(o.first_seen)},
                     {"last_seen", seconds(o.last_seen)}});
  nlohmann::ordered_json all{{"schema", "karst.objects/1"}, {"found", found}};
  if (team_) all["known"] = list_of(team_->objects());
  onboard_.recorder.objects(all);
}

}  // namespace karst::core
