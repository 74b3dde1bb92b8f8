// Takes what a policy's own process prints out of a pipe, on a thread of its own: the flight never waits for
// what is printed, and the process never for the flight.
#pragma once
#include <memory>
#include <optional>
#include <thread>

#include "sdk/host/boundary/policy_output.h"
#include "sdk/host/isolation/descriptor.h"

namespace karst::host {

class OutputDrain {
 public:
  /// Throws core::InputError if there is no pipe to be had.
  explicit OutputDrain(std::shared_ptr<PolicyOutput> output);
  /// Takes what is in the pipe still, and returns, also if somebody keeps the other end open.
  ~OutputDrain();
  OutputDrain(const OutputDrain&) = delete;
  OutputDrain& operator=(const OutputDrain&) = delete;

  /// Where to print; -1 once it is closed here. Close-on-exec.
  int write_end() const { return write_end_ ? write_end_->value : -1; }
  void close_write_end() { write_end_.reset(); }

 private:
  void drain();
  bool take();

  std::shared_ptr<PolicyOutput> output_;
  std::optional<Descriptor> read_end_, write_end_, stop_;
  std::thread thread_;
};

}  // namespace karst::host
