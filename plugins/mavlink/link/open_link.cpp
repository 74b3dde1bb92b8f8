#include "plugins/mavlink/link/open_link.h"

#include <charconv>

#include "core_stack/common/error.h"
#include "plugins/mavlink/link/serial_link.h"
#include "plugins/mavlink/link/udp_link.h"

namespace karst::mavlink {
namespace {

constexpr const char* kExpected =
    "expected udp:PORT, udp:ADDRESS:PORT or serial:DEVICE:BAUD, such as serial:/dev/ttyACM0:921600";

unsigned number(const std::string& address, const std::string& text, unsigned max) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value == 0 || value > max)
    throw core::InputError(address, text, kExpected);
  return value;
}

}  // namespace

std::unique_ptr<ByteLink> open_link(const std::string& address, Address autopilot) {
  const auto first = address.find(':'), last = address.rfind(':');
  if (first == std::string::npos) throw core::InputError(address, "", kExpected);
  const std::string kind = address.substr(0, first), end = address.substr(last + 1);
  const std::string middle = last > first ? address.substr(first + 1, last - first - 1) : "";
  if (kind == "udp") {
    const auto port = static_cast<std::uint16_t>(number(address, end, 65535));
    return std::make_unique<UdpLink>(middle.empty() ? UdpLink::wait_at(port, autopilot)
                                                    : UdpLink::to(middle, port));
  }
  if (kind == "serial" && !middle.empty())
    return std::make_unique<SerialLink>(middle, number(address, end, 10'000'000));
  throw core::InputError(address, "", kExpected);
}

}  // namespace karst::mavlink
