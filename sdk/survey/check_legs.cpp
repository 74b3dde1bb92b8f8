#include "sdk/survey/check_legs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core_stack/common/format_text.h"
#include "sdk/survey/loop_legs.h"

namespace karst::survey {
namespace {

constexpr double kMostOff_m = 0.02 + 0.0174;  // both ends are rounded to the centimetre: sqrt(3) * 0.01 m

}  // namespace

void check_legs(Readings& readings, const Network& network, const std::vector<core::Vec3>& positions_m) {
  const std::vector<bool> on_loop = legs_on_loops(readings, network);
  for (std::size_t i = 0; i < network.legs.size(); ++i) {
    if (on_loop[i]) continue;
    const Reading& r = readings.legs[network.legs[i]];
    const core::Vec3 made = positions_m[network.place[r.to]] - positions_m[network.place[r.from]];
    const double off_m = (made - r.vector_m()).norm();
    if (off_m <= kMostOff_m) continue;
    const double contradiction_m =
        r.style == Style::diving ? std::max(0.0, std::abs(r.rise_m) - r.length_m) : 0;
    if (!(off_m <= kMostOff_m + contradiction_m))
      throw readings.log.error(
          r.source, core::format_text("cavern puts the end of this leg %.2f m from where its reading leads, "
                                      "and it lies on no loop",
                                      off_m));
    readings.log.note(
        r.source,
        core::format_text("between tape and depth, the end of the leg is %.2f m from where the depth puts it",
                          off_m));
  }
}

}  // namespace karst::survey
