#include "core_stack/planning/search/search_heap.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>

namespace karst::core {
namespace {

/// Oracle: a plain map of what is open, searched from end to end.
RC_GTEST_PROP(SearchHeap, GivesWhatALinearSearchGives, ()) {
  std::map<std::uint32_t, std::uint32_t> places;
  const auto heap_index_of = [&](std::uint32_t node) -> std::uint32_t& { return places[node]; };
  SearchHeap heap(heap_index_of);
  std::map<std::uint32_t, OpenNode> open;
  const int steps = *rc::gen::inRange(1, 300);
  for (int i = 0; i < steps; ++i) {
    if (*rc::gen::inRange(0, 3) > 0) {
      const OpenNode n{static_cast<float>(*rc::gen::inRange(0, 20)),
                       static_cast<float>(*rc::gen::inRange(0, 5)),
                       static_cast<std::uint32_t>(*rc::gen::inRange(0, 40))};
      heap.push_or_lower(n);
      const auto known = open.find(n.node);
      if (known == open.end())
        open.emplace(n.node, n);
      else if (n.before(known->second))
        known->second = n;
    } else if (!open.empty()) {
      const auto least = std::min_element(
          open.begin(), open.end(), [](const auto& a, const auto& b) { return a.second.before(b.second); });
      const OpenNode top = heap.pop();
      RC_ASSERT(top.node == least->first);
      RC_ASSERT(top.estimate == least->second.estimate && top.cost == least->second.cost);
      RC_ASSERT(places[top.node] == 0u);
      open.erase(least);
    }
    RC_ASSERT(heap.empty() == open.empty());
  }
}

}  // namespace
}  // namespace karst::core
