// The texts and frames of the protocol, as its specification has them.
#include "sdk/live/foxglove.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace karst::live {
namespace {

using nlohmann::json;

std::string reason(const std::string& text) {
  const Request request = request_of(text);
  const auto* refused = std::get_if<Refused>(&request);
  return refused ? refused->reason : "";
}

TEST(Foxglove, TheServerSaysWhatItIs) {
  const json j = json::parse(server_info("karst 1", "session", {{"seed", "7"}}));
  EXPECT_EQ(j, json::parse(R"({"op":"serverInfo","name":"karst 1","capabilities":["time"],
                               "metadata":{"seed":"7"},"sessionId":"session"})"));
}

TEST(Foxglove, AChannelHasItsTopicEncodingAndSchema) {
  const json j = json::parse(advertisement({{"/a", {"std_msgs/msg/A", "uint8 x\n"}, Keeping::none},
                                            {"/b", {"std_msgs/msg/B", "uint8 y\n"}, Keeping::whole}}));
  EXPECT_EQ(j["op"], "advertise");
  EXPECT_EQ(j["channels"][1],
            json::parse(R"({"id":1,"topic":"/b","encoding":"cdr","schemaName":"std_msgs/msg/B",
                            "schema":"uint8 y\n","schemaEncoding":"ros2msg"})"));
}

TEST(Foxglove, AMessageHasOpcodeSubscriptionAndTimeBeforeIt) {
  const MessageHead head = message_head(0x01020304, 0x1122334455667788);
  EXPECT_EQ(std::string(head.begin(), head.end()),
            std::string("\x01\x04\x03\x02\x01\x88\x77\x66\x55\x44\x33\x22\x11", 13));
  EXPECT_EQ(time_frame(0x1122334455667788), std::string("\x02\x88\x77\x66\x55\x44\x33\x22\x11", 9));
}

TEST(Foxglove, AStatusMayReplaceTheOneBefore) {
  EXPECT_EQ(json::parse(status(StatusLevel::warning, "slow", "dropped")),
            json::parse(R"({"op":"status","level":1,"message":"slow","id":"dropped"})"));
  EXPECT_FALSE(json::parse(status(StatusLevel::error, "no")).contains("id"));
}

TEST(Foxglove, OfTheSubprotocolsOfferedTheOneThatIsKnownIsSpoken) {
  EXPECT_EQ(chosen_subprotocol("foxglove.sdk.v1, foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen_subprotocol("other,foxglove.sdk.v1"), "foxglove.sdk.v1");
  for (const char* none : {"", ",", "foxglove", "foxglove.websocket.v2", "foxglove.websocket.v1x"})
    EXPECT_EQ(chosen_subprotocol(none), "") << none;
}

TEST(Foxglove, ARequestNamesSubscriptionsAndChannels) {
  const Request r =
      request_of(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2},{"id":0,"channelId":9}]})");
  const auto& all = std::get<Subscribe>(r).all;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].id, 5u);
  EXPECT_EQ(all[1].channel, 9u);
  const Request u = request_of(R"({"op":"unsubscribe","subscriptionIds":[5,4294967295]})");
  EXPECT_EQ(std::get<Unsubscribe>(u).ids, (std::vector<std::uint32_t>{5, 4294967295u}));
}

TEST(Foxglove, WhatIsNoRequestIsRefusedWithTheReason) {
  EXPECT_NE(reason(""), "");
  EXPECT_NE(reason("[]"), "");
  EXPECT_NE(reason("{\"op\":7}"), "");
  EXPECT_NE(reason(std::string(50000, '[')), "");
  EXPECT_NE(reason(std::string("\xff\xfe\x00", 3)), "");
  for (const char* op : {"advertise", "setParameters", "callService", "fetchAsset"})
    EXPECT_NE(reason("{\"op\":\"" + std::string(op) + "\"}").find("only sends"), std::string::npos);
  for (const char* bad : {R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
                          R"({"op":"subscribe","subscriptions":[1]})",
                          R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":0}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":0}]})",
                          R"({"op":"subscribe","subscriptions":[{"id":1}]})",
                          R"({"op":"unsubscribe","subscriptionIds":["1"]})", R"({"op":"unsubscribe"})"})
    EXPECT_NE(reason(bad), "") << bad;
  json many{{"op", "unsubscribe"}, {"subscriptionIds", std::vector<int>(kMaxListed + 1, 1)}};
  EXPECT_NE(reason(many.dump()), "");
}

}  // namespace
}  // namespace karst::live
