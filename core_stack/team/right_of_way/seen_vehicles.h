// Vehicles in the air that are seen and not heard: who they are is not known, nor whether they see this one.
#pragma once
#include <deque>
#include <span>
#include <vector>

#include "core_stack/team/right_of_way/separation.h"

namespace karst::core {

class SeenVehicles {
 public:
  /// Takes in the bodies that one sensor saw in the air at `stamp`. Those near a `heard` vehicle are that
  /// vehicle. At most 32 others are followed.
  void note(std::span<const Vec3> bodies, TimeNs stamp, std::span<const Neighbour> heard);
  /// Where those that were seen to fly should be by now. One that flies is taken to stop for nobody
  /// (TeamPhase::landing); one that stands waits (TeamPhase::aside). Their numbers are beyond all robots'.
  std::vector<Neighbour> neighbours(TimeNs now) const;

 private:
  struct Sighting {
    TimeNs stamp = 0;
    Vec3 position = Vec3::Zero();
  };
  struct Track {
    RobotId number = 0;
    std::deque<Sighting> sightings;  // of the last second
    bool flies = false;              // it was seen to move as only a vehicle does; it has a number then
    Vec3 velocity_mps() const;
    bool stands(TimeNs now) const;
    bool moves_steadily() const;
    bool forgotten(TimeNs now) const;
  };
  Track* same_as(const Vec3& position, TimeNs stamp);

  std::vector<Track> tracks_;
  int begun_ = 0;
};

}  // namespace karst::core
