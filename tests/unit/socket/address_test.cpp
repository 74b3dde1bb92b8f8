#include "plugins/socket/address.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"

namespace karst::socket {
namespace {

TEST(Address, ReadsTcpAndUnix) {
  EXPECT_EQ(parse_address("tcp:14660").text(), "tcp:127.0.0.1:14660");
  EXPECT_EQ(parse_address("tcp:cave.example:1").host, "cave.example");
  EXPECT_EQ(parse_address("tcp:[::1]:80").host, "::1");
  EXPECT_EQ(parse_address("tcp:[::1]:80").text(), "tcp:[::1]:80");
  EXPECT_EQ(parse_address("unix:/tmp/a:b").path, "/tmp/a:b");
}

TEST(Address, RefusesOthersWithTheReason) {
  for (const char* bad : {"", "127.0.0.1:5", "tcp:", "tcp:host:", "tcp::5", "tcp:host:65536", "tcp:host:-1",
                          "tcp:host:5x", "unix:", "udp:host:5"})
    EXPECT_THROW(parse_address(bad), core::InputError) << bad;
  EXPECT_THROW(parse_address("unix:/" + std::string(200, 'a')), core::InputError);
  try {
    parse_address("tcp:host:5x");
  } catch (const core::InputError& e) {
    EXPECT_STREQ(e.what(),
                 "tcp:host:5x: the port is no number up to 65535; expected tcp:HOST:PORT, tcp:PORT or "
                 "unix:PATH");
  }
}

}  // namespace
}  // namespace karst::socket
