// Opens the link that an address names:
//   udp:14540                  waits there for the autopilot, and answers it
//   udp:192.168.4.1:14550      sends there, and hears from there only
//   serial:/dev/ttyACM0:921600 a serial line and its baud rate
#pragma once
#include <memory>
#include <string>

#include "plugins/mavlink/link/byte_link.h"
#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {

/// `autopilot`: whose frames tell the peer that is waited for. Throws InputError naming the address and the
/// reason.
std::unique_ptr<ByteLink> open_link(const std::string& address, Address autopilot);

}  // namespace karst::mavlink
