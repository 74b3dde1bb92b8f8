// Take-off: climbs to the first hover, or below a low roof to a hover with enough room.
#pragma once
#include "core_stack/mission/phases/path_execution.h"

namespace karst::core {

class TakeOff {
 public:
  TakeOff(Onboard& onboard, const PhaseMachine& phases, const PathExecution& path)
      : onboard_(onboard), phases_(phases), path_(path) {}

  void begin();
  enum class State { climbs, hovers, does_not_lift };
  State step(bool standing);
  /// Whether it descends again from a low roof: obstacles near the ground do not stop it then.
  bool below_roof() const { return below_roof_; }
  /// The height below which the ground is near.
  double ground_m() const;

 private:
  void choose_hover();
  void on_hover(const Vec3& hover);

  Onboard& onboard_;
  const PhaseMachine& phases_;
  const PathExecution& path_;
  bool below_roof_ = false;
  TimeNs begun_ = 0;
};

}  // namespace karst::core
