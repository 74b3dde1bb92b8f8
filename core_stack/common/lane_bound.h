// An object bound to one lane of the executive: only jobs on that lane can access it, one after another. It
// needs no lock, and the order of accesses is the same for any number of threads.
#pragma once
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "core_stack/common/executive.h"

namespace karst::core {

template <class Resident>
class LaneBound {
 public:
  template <class... Arguments>
  LaneBound(Executive& executive, Lane lane, Arguments&&... arguments)
      : executive_(executive), lane_(lane), resident_(std::forward<Arguments>(arguments)...) {}

  /// Runs `work(resident)` on the lane, and `use(what it returned)` on the loop's thread at now + budget.
  template <class Work, class Use>
  void job(const std::string& name, TimeNs budget, Work work, Use use) {
    using Result = std::invoke_result_t<Work&, Resident&>;
    auto result = std::make_shared<Result>();
    executive_.job(
        name, lane_, budget, [this, result, work = std::move(work)]() mutable { *result = work(resident_); },
        [result, use = std::move(use)]() mutable { use(*result); });
  }
  /// The same without a result.
  template <class Work>
  void job(const std::string& name, TimeNs budget, Work work) {
    executive_.job(
        name, lane_, budget, [this, work = std::move(work)]() mutable { work(resident_); }, [] {});
  }

  /// Direct access while no job runs: before the first one, and after the executive has been drained.
  Resident& while_idle() { return resident_; }

 private:
  Executive& executive_;
  Lane lane_;
  Resident resident_;
};

}  // namespace karst::core
