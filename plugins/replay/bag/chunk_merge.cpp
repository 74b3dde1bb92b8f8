#include "plugins/replay/bag/chunk_merge.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace karst::replay {

ChunkMerge::ChunkMerge(std::vector<core::TimeNs> start, Load load, std::size_t max_open_bytes)
    : start_(std::move(start)),
      order_(start_.size()),
      load_(std::move(load)),
      max_open_bytes_(max_open_bytes) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](auto a, auto b) { return start_[a] < start_[b]; });
}

void ChunkMerge::open_what_may_come_first() {
  std::erase_if(open_, [&](const Open& o) {
    const bool done = o.at == o.loaded.messages.size();
    if (done) open_bytes_ -= o.loaded.bytes.size();
    return done;
  });
  const auto earliest = [&] {
    core::TimeNs t = std::numeric_limits<core::TimeNs>::max();
    for (const Open& o : open_) t = std::min(t, o.loaded.messages[o.at].time);
    return t;
  };
  while (next_ < order_.size() &&
         (open_.empty() || (start_[order_[next_]] <= earliest() && open_bytes_ < max_open_bytes_))) {
    const std::size_t chunk = order_[next_++];
    LoadedChunk loaded = load_(chunk);
    if (loaded.messages.empty()) continue;
    std::stable_sort(loaded.messages.begin(), loaded.messages.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
    open_bytes_ += loaded.bytes.size();
    open_.push_back({chunk, 0, std::move(loaded)});
  }
}

std::optional<ChunkMerge::Item> ChunkMerge::next() {
  open_what_may_come_first();
  if (open_.empty()) return std::nullopt;
  Open& first = *std::min_element(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
    return std::tie(a.loaded.messages[a.at].time, a.chunk) < std::tie(b.loaded.messages[b.at].time, b.chunk);
  });
  const ChunkMessage& m = first.loaded.messages[first.at++];
  return Item{first.chunk, m, Bytes(first.loaded.bytes).subspan(m.offset, m.size)};
}

}  // namespace karst::replay
