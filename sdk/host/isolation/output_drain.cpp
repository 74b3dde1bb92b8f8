#include "sdk/host/isolation/output_drain.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "core_stack/common/error.h"

namespace karst::host {
namespace {

/// Together more than a pipe holds (64 KiB, or what an administrator set, up to 1 MiB).
constexpr std::size_t kRead_bytes = 64 * 1024;
constexpr int kReadsAtOnce = 32;

[[noreturn]] void no_pipe() {
  throw core::InputError("a policy's process", "",
                         std::string("no pipe can be had for what it prints: ") + std::strerror(errno));
}

}  // namespace

OutputDrain::OutputDrain(std::shared_ptr<PolicyOutput> output) : output_(std::move(output)) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) no_pipe();
  read_end_.emplace(ends[0]);
  write_end_.emplace(ends[1]);
  stop_.emplace(eventfd(0, EFD_CLOEXEC));
  // The process could open the pipe for reading, through /proc, and take what poll() has announced.
  if (stop_->value < 0 || fcntl(ends[0], F_SETFL, O_NONBLOCK) != 0) no_pipe();
  thread_ = std::thread([this] { drain(); });
}

OutputDrain::~OutputDrain() {
  eventfd_write(stop_->value, 1);
  thread_.join();
}

void OutputDrain::drain() {
  bool more = true;
  for (bool stopping = false; !stopping;) {
    // poll() ignores a negative descriptor: at the end of a pipe that nobody writes to it would return at
    // once.
    std::array<pollfd, 2> ready{{{more ? read_end_->value : -1, POLLIN, 0}, {stop_->value, POLLIN, 0}}};
    if (poll(ready.data(), ready.size(), -1) < 0 && errno != EINTR) return;
    stopping = ready[1].revents != 0;
    if (more) more = take();
  }
  output_->end_line();
}

/// Takes what is there, or some of a flood. Returns whether there may be more to come.
bool OutputDrain::take() {
  std::array<char, kRead_bytes> buffer;
  for (int i = 0; i < kReadsAtOnce; ++i) {
    const ssize_t n = read(read_end_->value, buffer.data(), buffer.size());
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    if (n == 0) return false;
    output_->add(std::string_view(buffer.data(), static_cast<std::size_t>(n)));
  }
  return true;
}

}  // namespace karst::host
