#include "sdk/live/record_feed.h"

#include <cstring>
#include <mutex>
#include <new>

namespace karst::live {
namespace {

/// Before each record: its part, and its length.
struct Head {
  std::uint32_t part = 0, bytes = 0;
};

}  // namespace

void RecordFeed::on_record(core::RecordPart part, std::string_view bytes) noexcept {
  const Head head{static_cast<std::uint32_t>(part), static_cast<std::uint32_t>(bytes.size())};
  if (own_.size() + sizeof head + bytes.size() > kMaxBytes) {
    ++own_lost_;
  } else {
    const std::size_t before = own_.size();
    try {
      own_.append(reinterpret_cast<const char*>(&head), sizeof head);
      own_.append(bytes);
    } catch (const std::bad_alloc&) {
      own_.resize(before);
      ++own_lost_;
    }
  }
  if (!mutex_.try_lock()) return;  // with the next record
  const std::lock_guard lock(mutex_, std::adopt_lock);
  hand_on();
}

void RecordFeed::on_close() noexcept {
  const std::lock_guard lock(mutex_);  // the flight is over
  hand_on();
  closed_ = true;
}

void RecordFeed::hand_on() {
  if (shared_.empty()) {
    shared_.swap(own_);
  } else if (shared_.size() + own_.size() <= kMaxBytes) {
    try {
      shared_.append(own_);
      own_.clear();
    } catch (const std::bad_alloc&) {  // it stays where it is
    }
  }
  lost_ = own_lost_;
}

RecordFeed::Progress RecordFeed::read(const std::function<void(core::RecordPart, std::string_view)>& f) {
  Progress progress;
  taken_.clear();
  {
    const std::lock_guard lock(mutex_);
    taken_.swap(shared_);
    progress = {lost_, closed_ && own_.empty()};
    if (closed_) hand_on();  // what found no room at the end: the recording thread is through
  }
  for (std::size_t at = 0; at < taken_.size();) {
    Head head;
    std::memcpy(&head, taken_.data() + at, sizeof head);
    at += sizeof head;
    f(static_cast<core::RecordPart>(head.part), std::string_view(taken_).substr(at, head.bytes));
    at += head.bytes;
  }
  return progress;
}

}  // namespace karst::live
