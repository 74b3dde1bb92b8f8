// Returns home while the battery suffices: decides when to turn back, and flies home through the map or back
// along the flown path. In a team it may fly to a relay landing site instead of the start.
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
    std::function<void(const std::string& reason)> land_here;  // away from home
    std::function<bool()> in_company;     // whether another vehicle is near, which may block the path briefly
    std::function<void()> give_up_goals;  // withdraws its claims in the team
  };
  struct Parts {
    const PhaseMachine& phases;
    GoalTracker& goals;
    PathExecution& path;
    const FlownPath& flown_path;
    const Endurance& endurance;
    RelayLanding* landing;  // null: lands at its start
  };
  ReturnHome(Onboard& onboard, const Parts& parts, Wiring wiring)
      : onboard_(onboard), parts_(parts), wiring_(std::move(wiring)) {}

  /// Sets home to the first hover.
  void set_home(const Vec3& hover);
  /// Checks once a second during exploration whether to turn back.
  void watch_time();
  /// It turns back now, or goes on home after it was to land elsewhere.
  void begin(const std::string& reason);
  /// Call ten times a second during the return.
  void step();
  /// Looks for another landing site, since another robot claimed this one earlier.
  void give_way_at_landing();

  /// The hover above where it will land.
  const Vec3& hover() const;
  /// The relay landing site, if it has one.
  std::optional<LandingSpot> landing_spot() const;
  /// Why it first went home; empty until then.
  const std::string& reason() const { return reason_; }
  /// Path length home, as last estimated.
  double distance_m() const { return distance_m_; }

 private:
  struct WayHome {
    Route route;
    bool as_come = false;  // along the flown path
  };
  void on_estimate(const HomeEstimate& estimate);
  bool leads_too_far(const HomeEstimate& estimate);
  void arrive();
  void find_path();
  void plan();
  double lasting_length_m() const;
  void on_plan(const WayHome& way, TimeNs begun);
  void follow_as_come(const Route& route, const std::string& why);
  bool blocked_on_the_way_back() const;
  void look_around();
  int max_failures() const;
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
  int failures_ = 0;                  // plans in a row that found no way
  bool planning_ = false;             // or choosing where to land
  bool chose_as_come_ = false;        // though there was a path through the map
  std::optional<Vec3> set_out_from_;  // along the flown path, the last time
  TimeNs retry_ = 0;                  // no way home: it is asked for again then
  TimeNs company_at_ = 0;             // when another vehicle was near the last time
};

}  // namespace karst::core
