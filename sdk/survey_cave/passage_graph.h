// The legs of a cave as a graph, and what is known at some of its nodes carried along it to the others.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "sdk/survey_cave/survey_part.h"

namespace karst::survey_cave {

constexpr std::uint32_t kNoNode = ~std::uint32_t{0};

/// A node for each station; one for stations that a leg of less than a centimetre joins.
struct PassageGraph {
  struct Edge {
    std::uint32_t leg = 0, node = 0;  // index into Survey::legs; the node at the other end
    double length_m = 0;
  };
  std::vector<std::uint32_t> node_of;                // by station; kNoNode outside the part
  std::vector<std::vector<std::uint32_t>> stations;  // by node
  std::vector<core::Vec3> places;                    // by node: of its first station, less the offset
  std::vector<std::vector<Edge>> edges;              // by node, in the order of the legs
  std::size_t size() const { return places.size(); }
};
PassageGraph graph_of(const survey::Survey& survey, const SurveyPart& part, const core::Vec3& offset_m);

/// By node: the number of the connected part it is in, in the order of their first nodes.
std::vector<std::uint32_t> connected_parts(const PassageGraph& graph);

/// By node: metres along the legs from the nearest of the sources; infinity if none is connected. With
/// `passable` (by leg of the survey), only along those legs.
std::vector<double> distances_along(const PassageGraph& graph, const std::vector<std::uint32_t>& sources,
                                    const std::vector<bool>* passable = nullptr);

/// By node: the value if it is known; else, of the two known nodes that are nearest along the legs, with no
/// third in between, the values weighted by the distance to the other one (linear between two along a
/// passage; the value itself where a passage ends); none if no known node is connected.
std::vector<std::optional<double>> interpolated(const PassageGraph& graph,
                                                const std::vector<std::optional<double>>& known);

}  // namespace karst::survey_cave
