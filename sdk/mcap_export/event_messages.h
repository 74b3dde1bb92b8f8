// What the events of a flight add to its topics. Each class owns what its topic remembers of earlier events,
// so that an export of all events, and a flight that is followed, give the same messages.
#pragma once
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "core_stack/mission/recording/run_event.h"
#include "sdk/mcap_export/flight_clock.h"
#include "sdk/mcap_export/markers.h"
#include "sdk/mcap_export/stamped.h"

namespace karst::mcap {

/// An event and its flight time, which never falls from one to the next.
struct TimedEvent {
  double t_s = 0;
  core::event::Event event;
};

/// Each planned path; the poses look along it.
struct PlanMessages {
  using Message = ros::Path;
  static constexpr const char* kTopic = "/plan";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);
};

/// Clusters as spheres whose volume grows with their unknown cells; those refused stay, with the reason.
class FrontierMessages {
 public:
  using Message = ros::MarkerArray;
  static constexpr const char* kTopic = "/frontiers";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);

 private:
  std::vector<core::event::Frontier> refused_;
  std::vector<core::event::Cluster> offered_;
};

/// The goals that are open, and the one of which the event tells.
class GoalMessages {
 public:
  using Message = ros::MarkerArray;
  static constexpr const char* kTopic = "/goals";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);

 private:
  std::vector<core::event::Goal> open_;
};

/// What the policy drew, all of one decision in one message: it is complete once a later event comes, or the
/// end.
class DrawingMessages {
 public:
  using Message = ros::MarkerArray;
  static constexpr const char* kTopic = "/drawings";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);
  std::optional<Stamped<Message>> end();

 private:
  std::optional<Markers> markers_;
  double at_s_ = 0;
  std::uint32_t number_ = 0;
};

/// What is known of the objects of interest at each event of one.
class ObjectMessages {
 public:
  using Message = ros::MarkerArray;
  static constexpr const char* kTopic = "/objects";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);

 private:
  std::map<std::uint32_t, core::event::Object> known_;
};

/// The phase as text above the vehicle: RViz shows no log.
struct PhaseMessages {
  using Message = ros::MarkerArray;
  static constexpr const char* kTopic = "/phase";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);
};

/// All events that have words.
struct LogMessages {
  using Message = ros::Log;
  static constexpr const char* kTopic = "/events";
  std::optional<Stamped<Message>> take(const TimedEvent& e, const FlightClock& clock);
};

using EventMessages = std::tuple<PlanMessages, FrontierMessages, GoalMessages, DrawingMessages,
                                 ObjectMessages, PhaseMessages, LogMessages>;

/// What is left when no further event comes.
template <class Messages>
std::optional<Stamped<typename Messages::Message>> end_of(Messages& messages) {
  if constexpr (requires { messages.end(); })
    return messages.end();
  else
    return std::nullopt;
}

}  // namespace karst::mcap
