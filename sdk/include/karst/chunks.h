// Splits a batch into calls of the size that the host takes.
#pragma once
#include <algorithm>
#include <cstddef>

namespace karst {

/// Calls f(begin, size) for one piece of `count` items after another, each of `limit` items at most. Without
/// any item it calls f(0, 0): the host's other checks are the same for every count.
template <class F>
void for_chunks(std::size_t count, std::size_t limit, F&& f) {
  std::size_t begin = 0;
  do {
    const std::size_t size = std::min(limit, count - begin);
    f(begin, size);
    begin += size;
  } while (begin < count);
}

}  // namespace karst
