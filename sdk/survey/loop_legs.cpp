#include "sdk/survey/loop_legs.h"

#include <algorithm>
#include <cstdint>

namespace karst::survey {
namespace {

struct Edge {
  std::uint32_t leg = 0, place = 0;  // index into Network::legs; the place at the other end
};

/// Bridges by a search in depth (Tarjan 1974): a leg that the search went along is one if nothing behind it
/// leads back to before it. Without recursion, for a survey may be one passage of a million legs.
class BridgeSearch {
 public:
  BridgeSearch(const std::vector<std::vector<Edge>>& edges, std::vector<bool>& on_loop)
      : edges_(edges), on_loop_(on_loop), number_(edges.size(), 0), lowest_(edges.size(), 0) {}

  void run() {
    for (std::uint32_t start = 0; start < edges_.size(); ++start)
      if (number_[start] == 0) search(start);
  }

 private:
  struct Step {
    std::uint32_t place = 0, by_leg = Network::kNone;
    std::size_t next = 0;  // of the place's edges
  };

  void reach(std::vector<Step>& way, std::uint32_t place, std::uint32_t by_leg) {
    number_[place] = lowest_[place] = ++count_;
    way.push_back({place, by_leg, 0});
  }

  void search(std::uint32_t start) {
    std::vector<Step> way;
    reach(way, start, Network::kNone);
    while (!way.empty()) {
      Step& at = way.back();
      const std::uint32_t place = at.place, by_leg = at.by_leg;
      if (at.next < edges_[place].size()) {
        const Edge e = edges_[place][at.next++];
        if (e.leg == by_leg) continue;
        if (number_[e.place] == 0)
          reach(way, e.place, e.leg);
        else
          lowest_[place] = std::min(lowest_[place], number_[e.place]);
        continue;
      }
      way.pop_back();
      if (way.empty()) break;
      const std::uint32_t before = way.back().place;
      if (lowest_[place] > number_[before]) on_loop_[by_leg] = false;
      lowest_[before] = std::min(lowest_[before], lowest_[place]);
    }
  }

  const std::vector<std::vector<Edge>>& edges_;
  std::vector<bool>& on_loop_;
  std::vector<std::uint32_t> number_, lowest_;  // in the order of the search, from 1; 0: not reached
  std::uint32_t count_ = 0;
};

}  // namespace

std::vector<bool> legs_on_loops(const Readings& readings, const Network& network) {
  std::vector<std::uint32_t> tied(network.stations.size());  // by place: itself, or the first fixed one
  for (std::uint32_t i = 0; i < tied.size(); ++i) tied[i] = i;
  for (const std::uint32_t f : network.fixes)
    tied[network.place[readings.fixes[f].station]] =
        network.place[readings.fixes[network.fixes.front()].station];
  std::vector<std::vector<Edge>> edges(network.stations.size());
  for (std::uint32_t i = 0; i < network.legs.size(); ++i) {
    const Reading& r = readings.legs[network.legs[i]];
    if (r.style == Style::no_survey) continue;
    const std::uint32_t a = tied[network.place[r.from]], b = tied[network.place[r.to]];
    edges[a].push_back({i, b});
    edges[b].push_back({i, a});
  }
  std::vector<bool> on_loop(network.legs.size(), true);
  BridgeSearch(edges, on_loop).run();
  return on_loop;
}

}  // namespace karst::survey
