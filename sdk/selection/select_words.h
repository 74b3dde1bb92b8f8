// Why a policy was selected, or none, in a sentence.
#pragma once
#include <string>

#include "sdk/selection/select.h"

namespace karst::selection {

/// What is farthest off: the figure here, and its range in the caves flown.
std::string why_far(const Experience& experience, const CaveFigures& cave, const NearCave& nearest,
                    double limit);
/// Of a cave that was flown itself.
std::string why_first_there(const Experience& experience, const Selected& selected,
                            const SelectOptions& options);
std::string why_first(const Experience& experience, const Selected& selected, const SelectOptions& options);

}  // namespace karst::selection
