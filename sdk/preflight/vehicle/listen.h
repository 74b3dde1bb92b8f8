// Listens to a vehicle as a flight would, and never commands it: Vehicle::command() is not called.
#pragma once
#include <atomic>
#include <functional>

#include "sdk/preflight/vehicle/vehicle_record.h"

namespace karst::preflight {

enum class ListenStep { rest, motion };

struct ListenOptions {
  core::TimeNs rest = 15 * core::kSecond;  // on the pad
  core::TimeNs motion = 0;                 // then turned by hand; 0: not
  core::Clock clock = core::Clock::lockstep;
  std::function<void(ListenStep)> begins = [](ListenStep) {};  // called at the beginning of a step
};

/// Ends early if the vehicle is lost or `interrupted` is set.
VehicleRecord listen(core::Vehicle& vehicle, const ListenOptions& options,
                     const std::atomic<bool>& interrupted);

}  // namespace karst::preflight
