// How much work an answer may cost, counted in steps and not by a clock: every run stops at the same place.
#pragma once
#include <cstdint>

namespace karst::core {

class WorkBudget {
 public:
  explicit WorkBudget(std::uint64_t steps) : left_(steps) {}

  /// False once more has been asked for than there was.
  bool spend(std::uint64_t steps) {
    exhausted_ = exhausted_ || steps > left_;
    if (!exhausted_) left_ -= steps;
    return !exhausted_;
  }
  bool exhausted() const { return exhausted_; }
  std::uint64_t left() const { return left_; }

 private:
  std::uint64_t left_;
  bool exhausted_ = false;
};

}  // namespace karst::core
