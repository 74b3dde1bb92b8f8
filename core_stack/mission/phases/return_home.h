// Going home while the battery still lasts for it: when to turn back, the way there through the map or back
// along the way come, and in a team the landing place instead of the start.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "core_stack/homing/path_home/home.h"
#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/flown_path.h"
#include "core_stack/mission/phases/goal_tracker.h"
#include "core_stack/mission/phases/path_execution.h"
#include "core_stack/mission/phases/relay_landing.h"
#include "core_stack/mission/phases/still_watch.h"

namespace karst::core {

class ReturnHome {
 public:
  struct Wiring {
    std::function<void(Phase, const std::string& reason)> enter;
    std::function<void(const std::string& reason)> land_here;  // not where it should
    std::function<bool()>
        in_company;  // another vehicle flies near: what is in the way may be gone in a moment
    std::function<void()> give_up_goals;  // tells the team that it explores no more
  };
  struct Parts {
    const PhaseMachine& phases;
    GoalTracker& goals;
    PathExecution& path;
    const FlownPath& flown_path;
    const Endurance& endurance;
    RelayLanding* landing;  // null: it lands at its start
  };
  ReturnHome(Onboard& onboard, const Parts& parts, Wiring wiring)
      : onboard_(onboard), parts_(parts), wiring_(std::move(wiring)) {}

  /// The first hover is where it comes back to.
  void set_home(const Vec3& hover);
  /// While it explores: once a second, whether it has to turn back.
  void watch_time();
  /// It turns back now, or goes on home after it was to land elsewhere.
  void begin(const std::string& reason);
  /// Ten times a second on the way.
  void step();
  /// Another robot has claimed the landing place before: it looks for one more.
  void give_way_at_landing();

  /// Where it flies to when it goes home, and comes down.
  const Vec3& hover() const;
  /// The landing place in a team, if it has one.
  std::optional<LandingSpot> landing_spot() const;
  /// Why it first went home; empty until then.
  const std::string& reason() const { return reason_; }
  /// By path, as last estimated.
  double distance_m() const { return distance_m_; }

 private:
  void on_estimate(const HomeEstimate& estimate);
  void arrive();
  void find_path();
  void plan();
  void on_plan(const Route& route, TimeNs begun);
  void fly_back_as_come();
  void choose_landing();
  void give_up_landing(const std::string& reason, RelayLanding::Because because);
  void watch_patience(bool at_home);
  RouteStart start(TimeNs at) const { return parts_.path.start_at_stop(at); }

  Onboard& onboard_;
  Parts parts_;
  Wiring wiring_;
  StillWatch still_;
  ReturnTrigger return_trigger_;
  Vec3 home_ = Vec3::Zero();
  double distance_m_ = 0;
  std::string reason_;
  int failures_ = 0;       // plans in a row that found no way
  bool planning_ = false;  // or choosing where to land
  TimeNs retry_ = 0;       // no way home, with another vehicle near: it is asked for again then
  TimeNs company_at_ = 0;  // when another vehicle was near the last time
};

}  // namespace karst::core
