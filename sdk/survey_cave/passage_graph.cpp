#include "sdk/survey_cave/passage_graph.h"

#include <limits>
#include <queue>
#include <tuple>

#include "sdk/survey/place_sets.h"

namespace karst::survey_cave {
namespace {

constexpr double kSamePlace_m = 0.01;

}  // namespace

PassageGraph graph_of(const survey::Survey& survey, const SurveyPart& part, const core::Vec3& offset_m) {
  const auto length_m = [&](const survey::Leg& leg) {
    return (survey.stations[leg.from].position_m - survey.stations[leg.to].position_m).norm();
  };
  survey::PlaceSets same(survey.stations.size());
  for (const std::uint32_t i : part.legs)
    if (const survey::Leg& leg = survey.legs[i]; length_m(leg) < kSamePlace_m) same.unite(leg.from, leg.to);
  PassageGraph graph;
  graph.node_of.assign(survey.stations.size(), kNoNode);
  for (const std::uint32_t s : part.stations) {
    std::uint32_t& node = graph.node_of[same.root(s)];
    if (node == kNoNode) {
      node = static_cast<std::uint32_t>(graph.places.size());
      graph.places.push_back(survey.stations[s].position_m - offset_m);
      graph.stations.emplace_back();
    }
    graph.node_of[s] = node;
    graph.stations[node].push_back(s);
  }
  graph.edges.resize(graph.places.size());
  for (const std::uint32_t i : part.legs) {
    const survey::Leg& leg = survey.legs[i];
    const std::uint32_t a = graph.node_of[leg.from], b = graph.node_of[leg.to];
    if (a == b) continue;
    const double length = (graph.places[a] - graph.places[b]).norm();
    if (length < kSamePlace_m) continue;  // between groups of stations at one place
    graph.edges[a].push_back({i, b, length});
    graph.edges[b].push_back({i, a, length});
  }
  return graph;
}

std::vector<std::uint32_t> connected_parts(const PassageGraph& graph) {
  std::vector<std::uint32_t> part(graph.size(), kNoNode);
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < graph.size(); ++first) {
    if (part[first] != kNoNode) continue;
    std::vector<std::uint32_t> stack{first};
    part[first] = count;
    while (!stack.empty()) {
      const std::uint32_t node = stack.back();
      stack.pop_back();
      for (const PassageGraph::Edge& e : graph.edges[node])
        if (part[e.node] == kNoNode) {
          part[e.node] = count;
          stack.push_back(e.node);
        }
    }
    ++count;
  }
  return part;
}

std::vector<double> distances_along(const PassageGraph& graph, const std::vector<std::uint32_t>& sources,
                                    const std::vector<bool>* passable) {
  using Reached = std::pair<double, std::uint32_t>;
  std::vector<double> distance(graph.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (const std::uint32_t s : sources) {
    distance[s] = 0;
    queue.emplace(0, s);
  }
  while (!queue.empty()) {
    const auto [d, node] = queue.top();
    queue.pop();
    if (d > distance[node]) continue;
    for (const PassageGraph::Edge& e : graph.edges[node])
      if ((passable == nullptr || (*passable)[e.leg]) && d + e.length_m < distance[e.node]) {
        distance[e.node] = d + e.length_m;
        queue.emplace(distance[e.node], e.node);
      }
  }
  return distance;
}

std::vector<std::optional<double>> interpolated(const PassageGraph& graph,
                                                const std::vector<std::optional<double>>& known) {
  using Label = std::pair<double, std::uint32_t>;                    // distance, source
  using Reached = std::tuple<double, std::uint32_t, std::uint32_t>;  // distance, node, source
  std::vector<std::vector<Label>> labels(graph.size());              // at most two
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  const auto spread = [&](double d, std::uint32_t node, std::uint32_t source) {
    for (const PassageGraph::Edge& e : graph.edges[node])
      if (!known[e.node]) queue.emplace(d + e.length_m, e.node, source);
  };
  for (std::uint32_t i = 0; i < graph.size(); ++i)
    if (known[i]) spread(0, i, i);
  while (!queue.empty()) {
    const auto [d, node, source] = queue.top();
    queue.pop();
    std::vector<Label>& at = labels[node];
    if (at.size() == 2 || (at.size() == 1 && at[0].second == source)) continue;
    at.emplace_back(d, source);
    spread(d, node, source);
  }
  std::vector<std::optional<double>> out = known;
  for (std::uint32_t i = 0; i < graph.size(); ++i) {
    const std::vector<Label>& at = labels[i];
    if (at.size() == 1) out[i] = known[at[0].second];
    if (at.size() == 2)
      out[i] = (*known[at[0].second] * at[1].first + *known[at[1].second] * at[0].first) /
               (at[0].first + at[1].first);
  }
  return out;
}

}  // namespace karst::survey_cave
