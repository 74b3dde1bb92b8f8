#include "sdk/campaign/paper/plot_look.h"

#include <array>

namespace karst::campaign {
namespace {

// Lightness (CIE L*) 0, 33, 50, 65 and 79.
constexpr std::array<std::string_view, 5> kColours = {"#000000", "#004f94", "#c8500a", "#4aa5dc", "#e3c31c"};
constexpr std::array<std::string_view, 6> kDashes = {"",          "5 2",  "1.4 1.8",
                                                     "7 2 1.4 2", "10 3", "3.5 1.4 1 1.4 1 1.4"};
constexpr std::array<std::string_view, 5> kMarks = {"M-2.2 0a2.2 2.2 0 1 0 4.4 0a2.2 2.2 0 1 0 -4.4 0Z",
                                                    "M-2 -2h4v4h-4Z", "M0 -2.6L2.4 1.8H-2.4Z",
                                                    "M0 -2.8L2.5 0L0 2.8L-2.5 0Z", "M0 2.6L2.4 -1.8H-2.4Z"};

}  // namespace

PlotLook plot_look(std::size_t i) {
  return {kColours[i % kColours.size()], kDashes[i % kDashes.size()], kMarks[i % kMarks.size()]};
}

}  // namespace karst::campaign
