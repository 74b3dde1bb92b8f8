// The records that a robot holds of every author, its own included.
#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include "core_stack/team/communication/messages.h"

namespace karst::core {

/// The set of an author's records that a robot holds, as a compact version vector entry.
class HeldNumbers {
 public:
  static constexpr std::uint32_t window = 32;  // how far beyond the first missing record others are accepted

  bool operator==(const HeldNumbers&) const = default;
  std::uint32_t first() const { return first_; }
  bool holds(std::uint32_t number) const {
    return number <= first_ ||
           (number > first_ + 1 && number - first_ - 2 < window && (beyond_ >> (number - first_ - 2) & 1));
  }
  bool takes(std::uint32_t number) const { return number <= first_ + 1 + window; }
  /// Requires takes(number).
  void add(std::uint32_t number) {
    if (number <= first_) return;
    if (number > first_ + 1) {
      beyond_ |= 1u << (number - first_ - 2);
      return;
    }
    ++first_;
    for (; beyond_ & 1; beyond_ >>= 1) ++first_;
    beyond_ >>= 1;
  }
  void set(const Held& h) {
    first_ = h.first;
    beyond_ = h.beyond;
  }
  Held summary(RobotId author) const { return {author, first_, beyond_}; }

 private:
  std::uint32_t first_ = 0, beyond_ = 0;
};

class RecordStore {
 public:
  explicit RecordStore(std::uint32_t max_records) : max_records_(max_records) {}

  enum class Taken { fresh, known, differs, too_far, full };
  Taken take(const SentRecord& r);
  const SentRecord* find(RobotId author, std::uint32_t number) const;
  const HeldNumbers& held(RobotId author) const { return held_[author]; }

 private:
  std::uint32_t max_records_;  // of one author
  std::array<HeldNumbers, kMaxRobots> held_;
  std::map<std::pair<RobotId, std::uint32_t>, SentRecord> records_;
};

}  // namespace karst::core
