// How large a passage is at its cross-sections: as it was measured there, else interpolated along the legs.
#pragma once
#include <vector>

#include "sdk/survey_cave/outline.h"
#include "sdk/survey_cave/passage_joints.h"

namespace karst::survey_cave {

/// By station: from it to the points on the wall underground.
using Splays = std::vector<std::vector<core::Vec3>>;
Splays splays_of(const survey::Survey& survey, const PassageGraph& graph, const core::Vec3& offset_m);

/// Of so many splays across the passage a section can be made.
constexpr std::size_t kLeastPoints = 4;

/// Of a joint.
struct SectionSize {
  core::Vec3 facing = core::Vec3::UnitY();  // horizontal; gives left and right where the normal is vertical
  Extents extents;                // left as seen along the joint's normal (at a shaft: along `facing`)
  bool any = false, all = false;  // of the extents are measured
  bool standing_in = false;       // of one at its node a median, or a metre: nothing connected was measured
};

struct SectionSizes {
  std::vector<SectionSize> at;                                               // by joint
  double measured_half_width_m = 0, measured_up_m = 0, measured_down_m = 0;  // medians; 0: none was measured
};

/// The section noted in a joint's own passage counts before those of other passages through its stations;
/// where nothing was noted, at least kLeastPoints splays do. What is missing is interpolated along the legs.
SectionSizes section_sizes(const survey::Survey& survey, const PassageGraph& graph,
                           const PassageJoints& passages, const Splays& splays);

/// The left of a section with this normal. A quarter turn from the way ahead, seen from above; where the
/// normal is vertical, from that of the joint, or from the way that its section faces.
core::Vec3 left_of(const Joint& joint, const core::Vec3& facing, const core::Vec3& normal);

/// Splays of the joint's stations in the section's plane: x left, y up. Those that run along the passage more
/// than across it are left out.
std::vector<Vec2> points_in(const Joint& joint, const core::Vec3& normal, const core::Vec3& left,
                            const PassageGraph& graph, const Splays& splays);

}  // namespace karst::survey_cave
