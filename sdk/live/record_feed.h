// Carries a record from the thread that writes it to the one that serves it.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "core_stack/common/inheriting_mutex.h"
#include "core_stack/mission/recording/record_listener.h"

namespace karst::live {

/// The recording thread only appends to memory of its own, and hands it on where it gets the mutex at once:
/// it never waits. What finds no room is lost, and counted.
class RecordFeed final : public core::RecordListener {
 public:
  /// Of either thread. Half an hour of poses, or a map's growth of two million cells.
  static constexpr std::size_t kMaxBytes = std::size_t{32} << 20;

  void on_record(core::RecordPart part, std::string_view bytes) noexcept override;
  void on_close() noexcept override;

  struct Progress {
    std::uint64_t lost = 0;  // records so far
    bool closed = false;     // nothing comes any more
  };
  /// The reader's thread: calls f for each record that has come since the last call, in their order.
  Progress read(const std::function<void(core::RecordPart, std::string_view)>& f);

 private:
  void hand_on();

  std::string own_;  // of the recording thread
  std::uint64_t own_lost_ = 0;

  core::InheritingMutex mutex_;  // of what follows
  std::string shared_;
  std::uint64_t lost_ = 0;
  bool closed_ = false;

  std::string taken_;  // of the reader
};

}  // namespace karst::live
