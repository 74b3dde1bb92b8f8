#include "sdk/live/foxglove.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core_stack/common/json_text.h"
#include "core_stack/common/little_endian.h"

namespace karst::live {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

enum class Opcode : std::uint8_t { message_data = 1, time = 2 };

/// A whole number from 0 to `most`; none for anything else.
std::optional<std::uint64_t> natural(const json& j, std::uint64_t most) {
  if (!j.is_number_unsigned()) return std::nullopt;
  const auto n = j.get<std::uint64_t>();
  return n <= most ? std::optional(n) : std::nullopt;
}

constexpr std::uint64_t kMaxId = std::numeric_limits<std::uint32_t>::max();

/// The list of a request, or null if there is none, or too long a one.
const json* list_of(const json& request, const char* name) {
  const auto found = request.find(name);
  return found != request.end() && found->is_array() && found->size() <= kMaxListed ? &*found : nullptr;
}

Request subscribe_of(const json& request) {
  const json* list = list_of(request, "subscriptions");
  if (!list) return Refused{"subscribe: \"subscriptions\" is no list of at most 256"};
  Subscribe out;
  for (const json& one : *list) {
    if (!one.is_object() || !one.contains("id") || !one.contains("channelId"))
      return Refused{"subscribe: a subscription has an id and a channelId"};
    const auto id = natural(one["id"], kMaxId), channel = natural(one["channelId"], kMaxId);
    if (!id || !channel) return Refused{"subscribe: id and channelId are whole numbers of 32 bits"};
    out.all.push_back({static_cast<std::uint32_t>(*id), *channel});
  }
  return out;
}

Request unsubscribe_of(const json& request) {
  const json* list = list_of(request, "subscriptionIds");
  if (!list) return Refused{"unsubscribe: \"subscriptionIds\" is no list of at most 256"};
  Unsubscribe out;
  for (const json& one : *list) {
    const auto id = natural(one, kMaxId);
    if (!id) return Refused{"unsubscribe: an id is a whole number of 32 bits"};
    out.ids.push_back(static_cast<std::uint32_t>(*id));
  }
  return out;
}

}  // namespace

std::string_view chosen_subprotocol(std::string_view offered) {
  const auto offers = [offered](std::string_view name) {
    for (std::size_t begin = 0; begin <= offered.size();) {
      const std::size_t comma = std::min(offered.find(',', begin), offered.size());
      std::string_view one = offered.substr(begin, comma - begin);
      while (one.starts_with(' ')) one.remove_prefix(1);
      while (one.ends_with(' ')) one.remove_suffix(1);
      if (one == name) return true;
      begin = comma + 1;
    }
    return false;
  };
  const auto* found = std::find_if(kSubprotocols.begin(), kSubprotocols.end(), offers);
  return found == kSubprotocols.end() ? std::string_view() : *found;
}

std::string server_info(const std::string& name, const std::string& session,
                        const std::map<std::string, std::string>& metadata) {
  return core::json_text(ordered_json{{"op", "serverInfo"},
                                      {"name", name},
                                      {"capabilities", {"time"}},
                                      {"metadata", metadata},
                                      {"sessionId", session}});
}

std::string advertisement(const std::vector<LiveTopic>& topics) {
  ordered_json channels = ordered_json::array();
  for (std::size_t i = 0; i < topics.size(); ++i)
    channels.push_back({{"id", i},
                        {"topic", topics[i].name},
                        {"encoding", "cdr"},
                        {"schemaName", topics[i].schema.name},
                        {"schema", topics[i].schema.definition},
                        {"schemaEncoding", "ros2msg"}});
  return core::json_text(ordered_json{{"op", "advertise"}, {"channels", std::move(channels)}});
}

std::string status(StatusLevel level, const std::string& text, const std::string& id) {
  ordered_json j{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}};
  if (!id.empty()) j["id"] = id;
  return core::json_text(j);
}

MessageHead message_head(std::uint32_t subscription, std::uint64_t time_ns) {
  std::string bytes;
  core::append_bytes(bytes, static_cast<std::uint8_t>(Opcode::message_data));
  core::append_bytes(bytes, subscription);
  core::append_bytes(bytes, time_ns);
  MessageHead head{};
  std::copy(bytes.begin(), bytes.end(), head.begin());
  return head;
}

std::string time_frame(std::uint64_t time_ns) {
  std::string bytes;
  core::append_bytes(bytes, static_cast<std::uint8_t>(Opcode::time));
  core::append_bytes(bytes, time_ns);
  return bytes;
}

Request request_of(std::string_view text) {
  const json request = core::json_of<json>(text);
  if (!request.is_object() || !request.contains("op") || !request["op"].is_string())
    return Refused{"no request: a JSON object with an \"op\""};
  const std::string op = request["op"].get<std::string>();
  if (op == "subscribe") return subscribe_of(request);
  if (op == "unsubscribe") return unsubscribe_of(request);
  return Refused{"this server only sends: it knows subscribe and unsubscribe"};
}

}  // namespace karst::live
