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

}  // namespace

SerialLink::SerialLink(const std::string& device, unsigned baud)
    : line_(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  const auto refuse = [&device] { throw core::InputError(device, "", std::strerror(errno)); };
  if (line_.get() < 0) refuse();
  const speed_t speed = speed_of(device, baud);
  termios settings{};
  if (::tcgetattr(line_.get(), &settings) != 0) refuse();
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  ::cfsetispeed(&settings, speed);
  ::cfsetospeed(&settings, speed);
  if (::tcsetattr(line_.get(), TCSANOW, &settings) != 0) refuse();
  ::tcflush(line_.get(), TCIOFLUSH);
}

void SerialLink::send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(line_.get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // the rest is lost, and the receiver finds the next frame
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

void SerialLink::receive(std::vector<std::uint8_t>& into) {
  std::array<std::uint8_t, 4096> bytes;
  for (;;) {
    const ssize_t n = ::read(line_.get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    into.insert(into.end(), bytes.begin(), bytes.begin() + n);
  }
}

}  // namespace karst::mavlink
