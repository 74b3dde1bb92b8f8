// A vehicle in another process, or on another computer, with a clock of its own.
//
// Messages are read in a short periodic step. The stamps are converted to the core's clock (clock_offset.h).
// A message waits until the core's time has reached its stamp: a core that is late takes what came meanwhile
// as if it were not. Pings go out ten times a second and serve as the heartbeat, too.
//
// An executive that loses time (Executive::lost_time()) sets its clock back, and what was measured meanwhile
// is out of date. The clocks are compared anew then. Until the first answer, nothing that is measured is
// taken and no command is sent: it would be for where the vehicle was.
#pragma once
#include <memory>
#include <optional>

#include "plugins/socket/clock_offset.h"
#include "plugins/socket/outstanding_pings.h"
#include "plugins/socket/vehicle_link.h"

namespace karst::socket {

/// What is concluded from silence. By then the vehicle steers itself, if it hears no commands either.
struct SilenceLimits {
  core::TimeNs autopilot_steers = core::kCommandTimeout;
  core::TimeNs vehicle_is_lost = 10 * core::kSecond;
};

class RealTimeVehicle final : public core::Vehicle {
 public:
  RealTimeVehicle(std::unique_ptr<VehicleLink> link, Wait patience, const SilenceLimits& limits);

  core::VehicleDescription description() const override { return link_->description(); }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command& c) override;
  std::vector<core::VehicleCheck> checks() const override;
  void finish() override;

 private:
  void step();
  std::optional<ToCore> for_core(ToCore message);
  void take(ToCore message);
  void note_lost_time();
  void ping();
  void judge_silence();
  void give_away(const std::string& reason);
  core::TimeNs late() const;
  void lose(const std::string& reason);

  std::unique_ptr<VehicleLink> link_;
  Wait patience_;
  SilenceLimits limits_;
  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  std::vector<core::VehicleCheck> checks_;
  OutstandingPings outstanding_;
  ClockOffset offset_;
  std::optional<ToCore> next_;                      // waits until the core's time has reached its stamp
  core::TimeNs next_ping_ = 0, heard_at_ = 0;       // by Executive::measured_now()
  core::TimeNs lost_time_ = 0;                      // of the executive, that is reckoned with
  core::Authority steers_ = core::Authority::core;  // as the vehicle says
  std::optional<core::TimeNs> known_since_;         // the core's state, as it says with its commands
  bool away_ = false, lost_ = false;                // steered by its autopilot because of silence
};

}  // namespace karst::socket
