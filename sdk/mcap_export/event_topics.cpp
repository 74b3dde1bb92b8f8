#include <algorithm>
#include <cmath>
#include <map>

#include "core_stack/common/format_text.h"
#include "sdk/mcap_export/event_words.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/markers.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

namespace event = core::event;
using core::Vec3;
using evaluation::RunRecord;

struct TimedEvent {
  double t_s = 0;
  event::Event event;
};
using Events = std::vector<TimedEvent>;

Events events_of(const RunRecord& run) {
  Events out;
  for (const nlohmann::json& line : run.events)
    if (auto e = event::read(line)) out.push_back({line["t"].get<double>(), std::move(*e)});
  std::stable_sort(out.begin(), out.end(),
                   [](const TimedEvent& a, const TimedEvent& b) { return a.t_s < b.t_s; });
  return out;
}

/// Calls f(time, event) for those of one kind.
template <class E, class F>
void for_each(const Events& events, const F& f) {
  for (const TimedEvent& e : events)
    if (const E* found = std::get_if<E>(&e.event)) f(e.t_s, *found);
}

Topic plan_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::Path>> out;
  for_each<event::Plan>(events, [&](double t_s, const event::Plan& plan) {
    ros::Path path{{clock.stamp(t_s), kMapFrame}, {}};
    for (std::size_t i = 0; i < plan.points.size(); ++i) {
      // Each pose looks along the path.
      const Vec3 along = i + 1 < plan.points.size() ? Vec3(plan.points[i + 1] - plan.points[i])
                         : i > 0                    ? Vec3(plan.points[i] - plan.points[i - 1])
                                                    : Vec3::UnitX();
      const core::Pose T{plan.points[i], core::from_heading(std::atan2(along.y(), along.x()))};
      path.poses.push_back({path.header, ros::pose(T)});
    }
    out.emplace_back(t_s, std::move(path));
  });
  return topic_of<ros::Path>("/plan", clock, std::move(out));
}

/// Clusters as spheres whose volume grows with their unknown cells; those refused stay, with the reason.
Topic frontier_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::MarkerArray>> out;
  std::vector<event::Frontier> refused;
  std::vector<event::Cluster> offered;
  for (const TimedEvent& e : events) {
    if (const auto* f = std::get_if<event::Frontier>(&e.event))
      refused.push_back(*f);
    else if (const auto* all = std::get_if<event::Frontiers>(&e.event))
      offered = all->clusters;
    else
      continue;
    Markers markers({clock.stamp(e.t_s), kMapFrame});
    for (const event::Cluster& c : offered) {
      const double diameter_m = std::clamp(0.05 * std::cbrt(c.unknown_cells), 0.2, 1.5);
      markers.sphere("offered", c.id, c.centroid, diameter_m, kOffered);
      markers.text("cells", c.id, c.centroid + Vec3(0, 0, diameter_m / 2 + 0.2),
                   core::format_text("%u: %u cells", c.id, c.unknown_cells), kText);
    }
    for (const event::Frontier& f : refused) {
      markers.sphere("refused", f.id, f.position, 0.3, kFailed);
      markers.text("reason", f.id, f.position + Vec3(0, 0, 0.35), f.reason, kText);
    }
    out.emplace_back(e.t_s, markers.take());
  }
  return topic_of<ros::MarkerArray>("/frontiers", clock, std::move(out));
}

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

/// The goals that are open, and the one of which the event tells.
Topic goal_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::MarkerArray>> out;
  std::vector<event::Goal> open;
  for_each<event::Goal>(events, [&](double t_s, const event::Goal& goal) {
    std::erase_if(open, [&](const event::Goal& g) { return g.position == goal.position; });
    std::vector<event::Goal> shown = open;
    shown.push_back(goal);
    if (goal.state == event::GoalState::accepted) open.push_back(goal);
    Markers markers({clock.stamp(t_s), kMapFrame});
    std::uint32_t number = 0;
    for (const event::Goal& g : shown) {
      if (!g.position.allFinite()) continue;
      const std::uint32_t id = number++;
      if (std::isfinite(g.heading_rad))
        markers.arrow("heading", id, {g.position, core::from_heading(g.heading_rad)}, 0.8,
                      colour_of(g.state));
      markers.sphere("goal", id, g.position, 0.3, colour_of(g.state));
      markers.text("why", id, g.position + Vec3(0, 0, 0.5), goal_text(g), kText);
    }
    out.emplace_back(t_s, markers.take());
  });
  return topic_of<ros::MarkerArray>("/goals", clock, std::move(out));
}

/// What the policy drew, all of one decision in one message.
Topic drawing_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::MarkerArray>> out;
  std::optional<Markers> markers;
  double at_s = 0;
  std::uint32_t number = 0;
  const auto end = [&] {
    if (markers) out.emplace_back(at_s, markers->take());
    markers.reset();
  };
  for_each<event::Drawing>(events, [&](double t_s, const event::Drawing& d) {
    if (markers && t_s != at_s) end();
    if (!markers) {
      markers.emplace(ros::Header{clock.stamp(t_s), kMapFrame});
      number = 0;
    }
    at_s = t_s;
    const Colour colour = colour_of_rgb(d.rgb);
    const std::uint32_t id = number++;
    switch (d.shape) {
      case core::Drawing::Kind::points:
        markers->points("points", id, d.points, colour);
        break;
      case core::Drawing::Kind::lines:
        markers->lines("lines", id, d.points, colour);
        break;
      case core::Drawing::Kind::text:
        if (!d.points.empty()) markers->text("text", id, d.points.front(), d.text, colour);
        break;
    }
  });
  end();
  return topic_of<ros::MarkerArray>("/drawings", clock, std::move(out));
}

/// What is known of the objects of interest at each event of one.
Topic object_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::MarkerArray>> out;
  std::map<std::uint32_t, event::Object> known;
  for_each<event::Object>(events, [&](double t_s, const event::Object& object) {
    if (object.state == core::ObjectState::withdrawn)
      known.erase(object.number);
    else if (object.position)
      known[object.number] = object;
    Markers markers({clock.stamp(t_s), kMapFrame});
    for (const auto& [number, o] : known) {
      markers.sphere("object", number, *o.position, 0.4, kReached);
      markers.text("what", number, *o.position + Vec3(0, 0, 0.5),
                   core::format_text("%u: %s", number, o.what ? core::name_of(*o.what) : "object"), kText);
    }
    out.emplace_back(t_s, markers.take());
  });
  return topic_of<ros::MarkerArray>("/objects", clock, std::move(out));
}

/// The phase as text above the vehicle: RViz shows no log.
Topic phase_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::MarkerArray>> out;
  const auto tell = [&](double t_s, const std::string& words) {
    Markers markers({clock.stamp(t_s), kBodyFrame});
    markers.text("phase", 0, Vec3(0, 0, 0.8), words, kText);
    out.emplace_back(t_s, markers.take());
  };
  for_each<event::Phase>(events, [&](double t_s, const event::Phase& p) {
    tell(t_s, core::name_of(p.phase) + (p.reason.empty() ? "" : ": " + p.reason));
  });
  return topic_of<ros::MarkerArray>("/phase", clock, std::move(out));
}

Topic log_topic(const Events& events, const FlightClock& clock) {
  std::vector<std::pair<double, ros::Log>> out;
  for (const TimedEvent& e : events)
    if (const std::optional<EventWords> words = words_of(e.event))
      out.emplace_back(e.t_s, ros::Log{clock.stamp(e.t_s), static_cast<std::uint8_t>(words->severity),
                                       words->kind, words->text, "", "", 0});
  return topic_of<ros::Log>("/events", clock, std::move(out));
}

}  // namespace

std::vector<Topic> event_topics(const RunRecord& run, const FlightClock& clock) {
  const Events events = events_of(run);
  return {plan_topic(events, clock),    frontier_topic(events, clock), goal_topic(events, clock),
          drawing_topic(events, clock), object_topic(events, clock),   phase_topic(events, clock),
          log_topic(events, clock)};
}

}  // namespace karst::mcap
