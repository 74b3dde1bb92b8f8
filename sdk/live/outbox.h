// What waits to be sent to one client, within a bound.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "sdk/live/live_topic.h"

namespace karst::live {

/// Where there is no room, the oldest messages of the same topic make it, and are counted as dropped; then
/// the oldest of the topics that hold most. Of a topic whose last message tells all, only that one waits: the
/// others are not counted.
class Outbox {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{8} << 20;  // or one message, if that is larger
  static constexpr std::size_t kMaxMessages = 4096;               // of a topic

  void put(const LiveMessage& message, Keeping keeping);
  /// The oldest message; none if nothing waits.
  std::optional<LiveMessage> take();
  /// Nothing of this topic waits any more.
  void forget(std::size_t topic);
  bool empty() const { return bytes_ == 0 && messages_ == 0; }
  std::size_t bytes() const { return bytes_; }

  const std::map<std::size_t, std::uint64_t>& dropped() const { return dropped_; }
  /// Dropped since the last call, of each topic.
  std::map<std::size_t, std::uint64_t> take_dropped() { return std::exchange(dropped_, {}); }

 private:
  struct Waiting {
    std::uint64_t number = 0;  // in the order of coming
    LiveMessage message;
  };
  struct Queue {
    std::deque<Waiting> waiting;
    std::size_t bytes = 0;
  };

  void pop(Queue& queue);
  void drop_oldest(std::size_t topic);
  std::size_t fullest() const;

  std::map<std::size_t, Queue> queues_;
  std::map<std::size_t, std::uint64_t> dropped_;
  std::size_t bytes_ = 0, messages_ = 0;
  std::uint64_t next_number_ = 0;
};

}  // namespace karst::live
