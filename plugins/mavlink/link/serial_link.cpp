#include "plugins/mavlink/link/serial_link.h"

#include <fcntl.h>
#include <termios.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core_stack/common/error.h"

namespace karst::mavlink {
namespace {

constexpr std::array<std::pair<unsigned, speed_t>, 9> kRates{{{57600, B57600},
                                                              {115200, B115200},
                                                              {230400, B230400},
                                                              {460800, B460800},
                                                              {500000, B500000},
                                                              {921600, B921600},
                                                              {1000000, B1000000},
                                                              {1500000, B1500000},
                                                              {3000000, B3000000}}};

speed_t speed_of(const std::string& device, unsigned baud) {
  const auto found =
      std::find_if(kRates.begin(), kRates.end(), [&](const auto& r) { return r.first == baud; });
  if (found != kRates.end()) return found->second;
  std::string known;
  for (const auto& [rate, speed] : kRates) known += " " + std::to_string(rate);
  throw core::InputError(device, std::to_string(baud), "is no baud rate known here; there is:" + known);
}

/// Throws InputError.
FileDescriptor open_line(const std::string& device, unsigned baud) {
  const auto refuse = [&device] { throw core::InputError(device, "", std::strerror(errno)); };
  FileDescriptor line(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (line.get() < 0) refuse();
  const speed_t speed = speed_of(device, baud);
  termios settings{};
  if (::tcgetattr(line.get(), &settings) != 0) refuse();
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  ::cfsetispeed(&settings, speed);
  ::cfsetospeed(&settings, speed);
  if (::tcsetattr(line.get(), TCSANOW, &settings) != 0) refuse();
  ::tcflush(line.get(), TCIOFLUSH);
  return line;
}

}  // namespace

SerialLink::SerialLink(const std::string& device, unsigned baud)
    : device_(device), baud_(baud), line_(open_line(device, baud)) {}

void SerialLink::send(std::span<const std::uint8_t> bytes) {
  while (line_ && !bytes.empty()) {
    const ssize_t n = ::write(line_->get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // the rest is lost, and the receiver finds the next frame
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

void SerialLink::receive(std::vector<std::uint8_t>& into) {
  const auto now = std::chrono::steady_clock::now();
  if (!line_ && now < try_at_) return;
  if (!line_) try {
      try_at_ = now + std::chrono::milliseconds(500);  // it takes time while the device is half back
      line_.emplace(open_line(device_, baud_));
    } catch (const core::InputError&) {
      return;  // not back yet
    }
  std::array<std::uint8_t, 4096> bytes;
  constexpr int kMost = 16;  // in one step: a flood must not hold up the loop
  for (int i = 0; i < kMost; ++i) {
    const ssize_t n = ::read(line_->get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return;
    if (n <= 0) return line_.reset();  // unplugged
    into.insert(into.end(), bytes.begin(), bytes.begin() + n);
  }
}

}  // namespace karst::mavlink
