// Foxglove's WebSocket protocol, version 1, as a server that only sends
// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md).
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sdk/live/live_topic.h"

namespace karst::live {

/// Names of the protocol: Foxglove's own, and that of its newer SDK. What is sent here is the same in both.
constexpr std::array<std::string_view, 2> kSubprotocols{"foxglove.websocket.v1", "foxglove.sdk.v1"};
/// The one to speak of those that a client offers, "a, b"; "" if there is none.
std::string_view chosen_subprotocol(std::string_view offered);

enum class StatusLevel : std::uint8_t { info = 0, warning = 1, error = 2 };

std::string server_info(const std::string& name, const std::string& session,
                        const std::map<std::string, std::string>& metadata);
/// Channels are numbered by their topics' places.
std::string advertisement(const std::vector<LiveTopic>& topics);
/// With an `id`, it replaces the status before of the same id.
std::string status(StatusLevel level, const std::string& text, const std::string& id = "");

/// What stands before a message's bytes in its frame: opcode, subscription, time.
using MessageHead = std::array<char, 13>;
MessageHead message_head(std::uint32_t subscription, std::uint64_t time_ns);
/// The flight's time, as a whole frame.
std::string time_frame(std::uint64_t time_ns);

struct Subscribe {
  struct One {
    std::uint32_t id = 0;
    std::uint64_t channel = 0;
  };
  std::vector<One> all;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
/// Nothing that this server does: why.
struct Refused {
  std::string reason;
};
using Request = std::variant<Subscribe, Unsubscribe, Refused>;

/// More of them in one request is refused.
constexpr std::size_t kMaxListed = 256;
/// What a client has sent, whatever it is.
Request request_of(std::string_view text);

}  // namespace karst::live
