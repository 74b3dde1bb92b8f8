// The reason for a selection, or for a refusal, in a sentence.
#pragma once
#include <string>

#include "sdk/selection/select.h"

namespace karst::selection {

/// The figure that differs most: its value here, and its range in the caves flown.
std::string why_far(const Experience& experience, const CaveFigures& cave, const NearCave& nearest,
                    double limit);
/// For a cave that was flown itself.
std::string why_first_there(const Experience& experience, const Selected& selected,
                            const SelectOptions& options);
std::string why_first(const Experience& experience, const Selected& selected, const SelectOptions& options);

}  // namespace karst::selection
