// How the legs of a cave join to passages: which two of a station go on as one.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sdk/survey_cave/passage_graph.h"

namespace karst::survey_cave {

/// A leg with a length, from node to node, and its cross-section's normal.
struct Way {
  std::uint32_t leg = 0;                // index into Survey::legs
  std::array<std::uint32_t, 2> node{};  // of the graph
  std::array<std::uint32_t, 2> joint{kNoNode, kNoNode};
  core::Vec3 axis = core::Vec3::UnitX();    // unit, from the first node to the second
  core::Vec3 normal = core::Vec3::UnitX();  // unit, of the cross-section; along the axis, but level if gentle
  double length_m = 0;
  double steep = 0;  // 0 gentle, 1 a shaft
};

struct WayEnd {
  std::uint32_t way = 0;
  std::size_t end = 0;  // 0 or 1
};

/// A cross-section: where one passage goes through a node, or ends there.
struct Joint {
  std::uint32_t node = 0;
  std::vector<WayEnd> ends;                 // two, or one
  core::Vec3 normal = core::Vec3::UnitX();  // along the way through: in by the first end, out by the second
  double steep = 0;
};
bool is_shaft(const Joint& joint);

struct PassageJoints {
  std::vector<Way> ways;  // in the order of the part's legs
  std::vector<Joint> joints;
};

/// At each node the two ends that turn least go on as one passage, then the two of the others that do; an end
/// that is left over, or would turn by more than 80 degrees, is a joint of its own.
PassageJoints joints_of(const survey::Survey& survey, const SurveyPart& part, const PassageGraph& graph);

/// By way: the first way of its passage. Ways are joined at joints of two.
std::vector<std::uint32_t> passage_numbers(const PassageJoints& joints);

}  // namespace karst::survey_cave
