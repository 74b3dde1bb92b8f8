// Limits the work of a query, counted in steps rather than time, so that every run stops at the same point.
#pragma once
#include <cstdint>

namespace karst::core {

class WorkBudget {
 public:
  explicit WorkBudget(std::uint64_t steps) : left_(steps) {}

  /// Returns false once the budget has been exceeded.
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
