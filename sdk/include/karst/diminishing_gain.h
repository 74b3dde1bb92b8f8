// When to stop: what is left promises little, and flights to such places have shown little for a while.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include <karst/memory.h>
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
  void memory(Memory& m) { m.add(by_clearance_); }

  /// Call with every request that has frontiers, and with the most that any of them may show. Where the core
  /// offers narrow passages when nothing else is left, they have a time of their own.
  bool over(const Request& request, double most_m3) {
    const karst_map_info_t map = request.map.info();
    const double known_m3 = static_cast<double>(map.free_cells) * std::pow(map.resolution_m, 3);
    Spent& spent =
        by_clearance_.try_emplace(request.clearance_m, Spent{0, request.stamp_ns, known_m3}).first->second;
    // While the vehicle is held on the spot, nobody asks, and no time is spent.
    spent.time_s += std::min(longest_step_s, static_cast<double>(request.stamp_ns - spent.last_ns) * 1e-9);
    spent.last_ns = request.stamp_ns;
    if (most_m3 >= little_m3 || known_m3 >= spent.known_m3 + little_m3)
      spent = {0, request.stamp_ns, known_m3};
    return give_up_s > 0 && spent.time_s > give_up_s;
  }

 private:
  static constexpr double longest_step_s = 5;
  struct Spent {
    double time_s;  // since something was last promised, or found
    std::int64_t last_ns;
    double known_m3;  // when it was
  };
  std::map<double, Spent> by_clearance_;
};

}  // namespace karst
