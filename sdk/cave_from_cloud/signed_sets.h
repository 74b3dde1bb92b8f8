// Disjoint sets (union by size, path compression) whose members also know whether they have the same sign as
// the others of their set.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace karst::from_cloud {

class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parent_(count), size_(count, 1), differs_(count, 0) {
    for (std::uint32_t i = 0; i < count; ++i) parent_[i] = i;
  }

  struct Root {
    std::uint32_t index;
    bool differs;  // whether the member's sign is not the root's
  };
  Root root(std::uint32_t member) {
    Root root{member, false};
    for (; parent_[root.index] != root.index; root.index = parent_[root.index])
      root.differs ^= differs_[root.index] != 0;
    bool left = root.differs;
    for (std::uint32_t i = member; i != root.index;) {
      const bool own = differs_[i] != 0;
      differs_[i] = left ? 1 : 0;
      left ^= own;
      i = std::exchange(parent_[i], root.index);
    }
    return root;
  }

  /// Unites the sets of two members. False, and nothing changes, if they are in one set.
  bool unite(std::uint32_t a, std::uint32_t b, bool differ = false) {
    Root large = root(a), small = root(b);
    if (large.index == small.index) return false;
    if (size_[large.index] < size_[small.index]) std::swap(large, small);
    parent_[small.index] = large.index;
    differs_[small.index] = (large.differs ^ small.differs ^ differ) ? 1 : 0;
    size_[large.index] += size_[small.index];
    return true;
  }

  std::size_t size_of_set(std::uint32_t member) { return size_[root(member).index]; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::size_t> size_;      // of a root's set
  std::vector<std::uint8_t> differs_;  // from the parent's sign
};

}  // namespace karst::from_cloud
