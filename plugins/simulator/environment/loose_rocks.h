// Which of the cave's boulders are present at a given time, and their positions.
#pragma once
#include <optional>

#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

class LooseRocks {
 public:
  explicit LooseRocks(std::vector<cave::LooseRock> boulders)
      : rocks_(std::move(boulders)), there_since_s_(rocks_.size()) {}

  /// Advances to a time later than the last. Returns whether any boulder appeared or moved.
  bool advance(double t_s, const core::Vec3& vehicle);
  std::vector<cave::Sphere> present() const;

 private:
  std::vector<cave::LooseRock> rocks_;
  std::vector<std::optional<double>> there_since_s_;
  double t_s_ = 0;
};

}  // namespace karst::sim
