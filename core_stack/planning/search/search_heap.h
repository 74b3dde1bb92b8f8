// The open list of a grid search: a binary heap that holds every node once and moves it up when a cheaper
// path to it is found (decrease-key). Each node stores its index in the heap, so no lookup is needed.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

namespace karst::core {

struct OpenNode {
  float estimate, cost;  // of the whole path through the node, and of the path to it
  std::uint32_t node;
  /// Smallest estimate first, then the larger cost so far, then the older node.
  bool before(const OpenNode& o) const {
    if (estimate != o.estimate) return estimate < o.estimate;
    if (cost != o.cost) return cost > o.cost;
    return node < o.node;
  }
};

/// `HeapIndexOf(node)` returns a reference to the node's std::uint32_t, initially 0, which the heap
/// maintains.
template <class HeapIndexOf>
class SearchHeap {
 public:
  explicit SearchHeap(HeapIndexOf heap_index_of) : heap_index_of_(std::move(heap_index_of)) {}

  bool empty() const { return heap_.empty(); }
  /// Adds a node, or moves it up if it is in the heap and `n` comes before its entry there.
  void push_or_lower(const OpenNode& n) {
    const std::uint32_t heap_index = heap_index_of_(n.node);
    if (heap_index == 0) {
      heap_.push_back(n);
      rise(heap_.size() - 1, n);
    } else if (n.before(heap_[heap_index - 1])) {
      rise(heap_index - 1, n);
    }
  }
  OpenNode pop() {
    const OpenNode top = heap_.front(), last = heap_.back();
    heap_.pop_back();
    heap_index_of_(top.node) = 0;
    if (!heap_.empty()) sink(last);
    return top;
  }

 private:
  void put(std::size_t i, const OpenNode& n) {
    heap_[i] = n;
    heap_index_of_(n.node) = static_cast<std::uint32_t>(i + 1);
  }
  void rise(std::size_t i, const OpenNode& n) {
    for (; i > 0 && n.before(heap_[(i - 1) / 2]); i = (i - 1) / 2) put(i, heap_[(i - 1) / 2]);
    put(i, n);
  }
  /// Sinks `n` from the top.
  void sink(const OpenNode& n) {
    std::size_t i = 0;
    for (std::size_t child; (child = 2 * i + 1) < heap_.size(); i = child) {
      if (child + 1 < heap_.size() && heap_[child + 1].before(heap_[child])) ++child;
      if (!heap_[child].before(n)) break;
      put(i, heap_[child]);
    }
    put(i, n);
  }

  HeapIndexOf heap_index_of_;
  std::vector<OpenNode> heap_;
};

}  // namespace karst::core
