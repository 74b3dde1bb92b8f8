#include "plugins/socket/wire.h"

#include <gtest/gtest.h>

#include "tests/unit/socket/any_message.h"

namespace karst::socket {
namespace {

using testing::bytes_of;
using testing::for_each_type;
using testing::frame_of;

template <class Variant>
void check_round_trips(const char* name) {
  rc::check(name, [] {
    for_each_type<Variant>([](const auto& message) {
      const std::string bytes = bytes_of(message);
      std::string problem;
      const auto read = read_message<Variant>(frame_of(bytes), problem);
      if (!read) RC_FAIL(problem);
      RC_ASSERT(std::visit([](const auto& m) { return bytes_of(m); }, *read) == bytes);
    });
  });
}

TEST(Wire, EveryMessageComesBackAsItWasWritten) {
  check_round_trips<ToVehicle>("to the vehicle");
  check_round_trips<ToCore>("to the core");
}

TEST(Wire, EveryPrefixOfAMessageIsRefused) {
  rc::check([] {
    for_each_type<ToCore>([](const auto& message) {
      const std::string bytes = bytes_of(message);
      const Frame whole = frame_of(bytes);
      std::string problem;
      for (std::size_t size = 0; size < whole.body.size(); ++size) {
        const auto read = read_message<ToCore>({whole.type, whole.body.substr(0, size)}, problem);
        RC_ASSERT(!read);
        RC_ASSERT(!problem.empty());
      }
    });
  });
}

TEST(Wire, ALongerBodyIsRefused) {
  std::string bytes = bytes_of(Done{5});
  bytes += 'x';
  std::string problem;
  EXPECT_FALSE(read_message<ToCore>(frame_of(bytes), problem));
  EXPECT_EQ(problem, "done: 1 bytes too long");
}

TEST(Wire, AnUnknownTypeIsRefused) {
  std::string problem;
  EXPECT_FALSE(read_message<ToCore>({999, ""}, problem));
  EXPECT_EQ(problem, "type 999: there is no such message here");
  EXPECT_FALSE(read_message<ToVehicle>({kType<Done>.id, ""}, problem)) << "it comes from the other side only";
}

/// A count of four thousand million elements, and none of them: nothing is allocated for it.
TEST(Wire, AnAbsurdCountIsRefused) {
  std::string body(8, '\0');
  body += std::string(4, '\xff');
  std::string problem;
  EXPECT_FALSE(read_message<ToCore>({kType<core::LidarScan>.id, body}, problem));
  EXPECT_EQ(problem, "lidar: range_m is cut off or not valid");
}

TEST(Wire, AnEnumerationHasItsValuesOnly) {
  std::string bytes = bytes_of(AuthorityChange{1, core::Authority::pilot, ""});
  std::string problem;
  EXPECT_TRUE(read_message<ToCore>(frame_of(bytes), problem));
  bytes[kHeaderBytes + 8] = 3;
  EXPECT_FALSE(read_message<ToCore>(frame_of(bytes), problem));
  EXPECT_EQ(problem, "authority: who is cut off or not valid");
}

/// Written by hand from docs/vehicle_protocol.md.
TEST(Wire, BytesAreThoseOfThePage) {
  EXPECT_EQ(bytes_of(socket::Run{0x01020304, 0x0a}),
            std::string("\x0c\0\0\0\x03\0\0\0\x04\x03\x02\x01\x0a\0\0\0\0\0\0\0", 20));
  EXPECT_EQ(bytes_of(Bye{"no"}), std::string("\x04\0\0\0\x07\0\0\0\x02\0no", 12));
  EXPECT_EQ(bytes_of(Hello{}).substr(8, 4), "KRVE");
}

}  // namespace
}  // namespace karst::socket
