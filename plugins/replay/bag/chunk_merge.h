// Merges the chunks of a bag, whose times may overlap, into one sequence of messages in the order of time.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "core_stack/common/time.h"
#include "plugins/replay/bag/bytes.h"

namespace karst::replay {

struct ChunkMessage {
  core::TimeNs time = 0;
  std::size_t connection = 0;
  std::size_t offset = 0, size = 0;  // in the chunk's bytes
};

struct LoadedChunk {
  std::string bytes;
  std::vector<ChunkMessage> messages;
};

class ChunkMerge {
 public:
  struct Item {
    std::size_t chunk = 0;
    ChunkMessage message;
    Bytes bytes;  // valid until the next call
  };
  using Load = std::function<LoadedChunk(std::size_t chunk)>;

  /// `start` is the time of each chunk's first message. At most `max_open_bytes` of chunks (and one chunk)
  /// are in memory: if more of them overlap, the order is no longer that of time.
  ChunkMerge(std::vector<core::TimeNs> start, Load load, std::size_t max_open_bytes);

  std::optional<Item> next();

 private:
  struct Open {
    std::size_t chunk = 0, at = 0;
    LoadedChunk loaded;
  };
  void open_what_may_come_first();

  std::vector<core::TimeNs> start_;
  std::vector<std::size_t> order_;  // chunks by start
  Load load_;
  std::size_t max_open_bytes_, open_bytes_ = 0, next_ = 0;
  std::vector<Open> open_;
};

}  // namespace karst::replay
