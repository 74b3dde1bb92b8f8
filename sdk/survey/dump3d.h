// The text that Survex's dump3d prints of a processed survey.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "sdk/survey/survey.h"

namespace karst::survey {

struct Dump3d {
  std::string title;
  char separator = '.';  // of surveys in names
  struct Node {
    core::Vec3 position_m = core::Vec3::Zero();  // to the centimetre
    std::string name;                            // empty: anonymous
    bool surface = false, underground = false, entrance = false, fixed = false, wall = false;
  };
  struct Line {
    core::Vec3 from_m = core::Vec3::Zero(), to_m = core::Vec3::Zero();
    std::optional<Style> style;
    std::uint32_t run = 0;
    bool surface = false, duplicate = false, splay = false;
  };
  struct CrossSection {
    std::string station;
    Dimensions dimensions;
    std::uint32_t series = 0;
  };
  std::vector<Node> nodes;
  std::vector<Line> lines;
  std::vector<CrossSection> sections;
};

/// Throws core::InputError naming `shown_as` and the line of the text that cannot be read, and for an
/// extended elevation, whose stations lie in one plane.
Dump3d read_dump3d(const std::filesystem::path& text, const std::string& shown_as);

}  // namespace karst::survey
