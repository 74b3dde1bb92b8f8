// A vehicle in another process that flies in lockstep: its clock moves only when the core's does.
//
// The vehicle tells what it has scheduled, as slots. Each slot is mirrored in the core's executive, in the
// order in which the vehicle scheduled them; when a slot is due, the vehicle runs it, and the core takes what
// it measured there. So whatever is due at one time runs in the order in which it would run in one process,
// and gives the same bytes.
#pragma once
#include <memory>

#include "plugins/socket/vehicle_link.h"

namespace karst::socket {

class LockstepVehicle final : public core::Vehicle {
 public:
  /// The vehicle is reported lost after `patience` without an answer.
  LockstepVehicle(std::unique_ptr<VehicleLink> link, Wait patience);

  core::VehicleDescription description() const override { return link_->description(); }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command& c) override;
  std::vector<core::VehicleCheck> checks() const override;
  void finish() override;

 private:
  template <class Request>
  void ask(const Request& request);
  void take_answer();
  void take(ToCore message);
  void mirror(const Schedule& slot);
  void run_slot(std::uint32_t slot);
  void lose(const std::string& reason);

  std::unique_ptr<VehicleLink> link_;
  Wait patience_;
  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  std::vector<core::VehicleCheck> checks_;
  bool lost_ = false;
  core::TimeNs last_run_ = -1;
  int runs_at_once_ = 0;
};

}  // namespace karst::socket
