// When to stop: what is left promises little, and flights to such places have shown nothing for a while.
#pragma once
#include <cmath>
#include <cstdint>

#include <karst/policy.h>

namespace karst {

class DiminishingGain {
 public:
  double little_m3 = 6.0;
  double give_up_s = 60.0;  // 0: never

  void parameters(Parameters& p) {
    p.add("little", little_m3, "m^3", 0, 1000, "a frontier that shows less may be noise of the map");
    p.add("give_up", give_up_s, "s", 0, 3600,
          "when only such frontiers are left, and flying to them has shown less than `little` for this long, "
          "the cave counts as explored; 0: never");
  }

  /// Call at every decision, with the most that any frontier left may show.
  bool over(const Request& request, double most_m3) {
    const karst_map_info_t map = request.map.info();
    const double known_m3 = static_cast<double>(map.free_cells) * std::pow(map.resolution_m, 3);
    if (since_ns_ < 0 || most_m3 >= little_m3 || known_m3 >= since_m3_ + little_m3) {
      since_ns_ = request.stamp_ns;
      since_m3_ = known_m3;
    }
    return give_up_s > 0 && static_cast<double>(request.stamp_ns - since_ns_) * 1e-9 > give_up_s;
  }

 private:
  std::int64_t since_ns_ = -1;  // something was last promised, or found
  double since_m3_ = 0;         // the volume known then
};

}  // namespace karst
