#include "sdk/mcap_export/event_messages.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/format_text.h"
#include "sdk/mcap_export/event_words.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

namespace event = core::event;
using core::Vec3;

Colour colour_of(event::GoalState state) {
  switch (state) {
    case event::GoalState::accepted:
      return kAccepted;
    case event::GoalState::reached:
      return kReached;
    case event::GoalState::superseded:
      return kPassed;
    case event::GoalState::rejected:
    case event::GoalState::unreachable:
    case event::GoalState::abandoned:
      return kFailed;
  }
  return kFailed;
}

std::string goal_text(const event::Goal& g) {
  std::string text = core::name_of(g.state);
  if (std::isfinite(g.score)) text += core::format_text(", score %.2f", g.score);
  for (const std::string& words : {g.why, g.reason})
    if (!words.empty()) text += "\n" + words;
  return text;
}

void draw(const event::Drawing& d, std::uint32_t id, Markers& markers) {
  const Colour colour = colour_of_rgb(d.rgb);
  switch (d.shape) {
    case core::Drawing::Kind::points:
      markers.points("points", id, d.points, colour);
      break;
    case core::Drawing::Kind::lines:
      markers.lines("lines", id, d.points, colour);
      break;
    case core::Drawing::Kind::text:
      if (!d.points.empty()) markers.text("text", id, d.points.front(), d.text, colour);
      break;
  }
}

}  // namespace

std::optional<Stamped<ros::Path>> PlanMessages::take(const TimedEvent& e, const FlightClock& clock) {
  const auto* plan = std::get_if<event::Plan>(&e.event);
  if (!plan) return std::nullopt;
  const std::vector<Vec3>& points = plan->points;
  ros::Path path{{clock.stamp(e.t_s), kMapFrame}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 along = i + 1 < points.size() ? Vec3(points[i + 1] - points[i])
                       : i > 0               ? Vec3(points[i] - points[i - 1])
                                             : Vec3::UnitX();
    const core::Pose T{points[i], core::from_heading(std::atan2(along.y(), along.x()))};
    path.poses.push_back({path.header, ros::pose(T)});
  }
  return Stamped<ros::Path>{e.t_s, std::move(path)};
}

std::optional<Stamped<ros::MarkerArray>> FrontierMessages::take(const TimedEvent& e,
                                                                const FlightClock& clock) {
  if (const auto* f = std::get_if<event::Frontier>(&e.event))
    refused_.push_back(*f);
  else if (const auto* all = std::get_if<event::Frontiers>(&e.event))
    offered_ = all->clusters;
  else
    return std::nullopt;
  Markers markers({clock.stamp(e.t_s), kMapFrame});
  for (const event::Cluster& c : offered_) {
    const double diameter_m = std::clamp(0.05 * std::cbrt(c.unknown_cells), 0.2, 1.5);
    markers.sphere("offered", c.id, c.centroid, diameter_m, kOffered);
    markers.text("cells", c.id, c.centroid + Vec3(0, 0, diameter_m / 2 + 0.2),
                 core::format_text("%u: %u cells", c.id, c.unknown_cells), kText);
  }
  for (const event::Frontier& f : refused_) {
    markers.sphere("refused", f.id, f.position, 0.3, kFailed);
    markers.text("reason", f.id, f.position + Vec3(0, 0, 0.35), f.reason, kText);
  }
  return Stamped<ros::MarkerArray>{e.t_s, markers.take()};
}

std::optional<Stamped<ros::MarkerArray>> GoalMessages::take(const TimedEvent& e, const FlightClock& clock) {
  const auto* goal = std::get_if<event::Goal>(&e.event);
  if (!goal) return std::nullopt;
  std::erase_if(open_, [&](const event::Goal& g) { return g.position == goal->position; });
  std::vector<event::Goal> shown = open_;
  shown.push_back(*goal);
  if (goal->state == event::GoalState::accepted) open_.push_back(*goal);
  Markers markers({clock.stamp(e.t_s), kMapFrame});
  std::uint32_t number = 0;
  for (const event::Goal& g : shown) {
    if (!g.position.allFinite()) continue;
    const std::uint32_t id = number++;
    if (std::isfinite(g.heading_rad))
      markers.arrow("heading", id, {g.position, core::from_heading(g.heading_rad)}, 0.8, colour_of(g.state));
    markers.sphere("goal", id, g.position, 0.3, colour_of(g.state));
    markers.text("why", id, g.position + Vec3(0, 0, 0.5), goal_text(g), kText);
  }
  return Stamped<ros::MarkerArray>{e.t_s, markers.take()};
}

std::optional<Stamped<ros::MarkerArray>> DrawingMessages::take(const TimedEvent& e,
                                                               const FlightClock& clock) {
  std::optional<Stamped<ros::MarkerArray>> complete;
  if (e.t_s != at_s_) complete = end();
  const auto* d = std::get_if<event::Drawing>(&e.event);
  if (!d) return complete;
  if (!markers_) {
    markers_.emplace(ros::Header{clock.stamp(e.t_s), kMapFrame});
    number_ = 0;
    at_s_ = e.t_s;
  }
  draw(*d, number_++, *markers_);
  return complete;
}

std::optional<Stamped<ros::MarkerArray>> DrawingMessages::end() {
  if (!markers_) return std::nullopt;
  Stamped<ros::MarkerArray> out{at_s_, markers_->take()};
  markers_.reset();
  return out;
}

std::optional<Stamped<ros::MarkerArray>> ObjectMessages::take(const TimedEvent& e, const FlightClock& clock) {
  const auto* object = std::get_if<event::Object>(&e.event);
  if (!object) return std::nullopt;
  if (object->state == core::ObjectState::withdrawn)
    known_.erase(object->number);
  else if (object->position)
    known_[object->number] = *object;
  Markers markers({clock.stamp(e.t_s), kMapFrame});
  for (const auto& [number, o] : known_) {
    markers.sphere("object", number, *o.position, 0.4, kReached);
    markers.text("what", number, *o.position + Vec3(0, 0, 0.5),
                 core::format_text("%u: %s", number, o.what ? core::name_of(*o.what) : "object"), kText);
  }
  return Stamped<ros::MarkerArray>{e.t_s, markers.take()};
}

std::optional<Stamped<ros::MarkerArray>> PhaseMessages::take(const TimedEvent& e, const FlightClock& clock) {
  const auto* p = std::get_if<event::Phase>(&e.event);
  if (!p) return std::nullopt;
  Markers markers({clock.stamp(e.t_s), kBodyFrame});
  markers.text("phase", 0, Vec3(0, 0, 0.8),
               core::name_of(p->phase) + (p->reason.empty() ? "" : ": " + p->reason), kText);
  return Stamped<ros::MarkerArray>{e.t_s, markers.take()};
}

std::optional<Stamped<ros::Log>> LogMessages::take(const TimedEvent& e, const FlightClock& clock) {
  const std::optional<EventWords> words = words_of(e.event);
  if (!words) return std::nullopt;
  return Stamped<ros::Log>{e.t_s, ros::Log{clock.stamp(e.t_s), static_cast<std::uint8_t>(words->severity),
                                           words->kind, words->text, "", "", 0}};
}

}  // namespace karst::mcap
