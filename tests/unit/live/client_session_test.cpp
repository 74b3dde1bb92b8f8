// What a client is sent: the greeting, what it asks for, what it may know of earlier, and what it is told if
// it is slow.
#include "sdk/live/client_session.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace karst::live {
namespace {

using nlohmann::json;

LiveMessage message(std::size_t topic, std::uint64_t time_ns, std::size_t bytes = 4) {
  return {topic, time_ns, std::make_shared<const std::string>(bytes, static_cast<char>('a' + topic))};
}

class Session : public testing::Test {
 protected:
  Session() {
    session_.next();
    session_.next();  // the greeting
  }
  void subscribe(std::uint32_t id, std::size_t channel) {
    session_.receive(
        json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}.dump());
  }
  void publish(const LiveMessage& m) {
    retained_.keep(m);
    session_.publish(m);
  }
  /// Subscription and time of each message that waits, and the texts.
  std::vector<std::pair<std::uint32_t, std::uint64_t>> messages() {
    std::vector<std::pair<std::uint32_t, std::uint64_t>> out;
    texts_.clear();
    while (const auto frame = session_.next()) {
      if (!frame->binary) texts_.push_back(json::parse(*frame->bytes));
      if (!frame->head) continue;
      std::uint32_t id = 0;
      std::uint64_t t = 0;
      std::memcpy(&id, frame->head->data() + 1, 4);
      std::memcpy(&t, frame->head->data() + 5, 8);
      out.emplace_back(id, t);
    }
    return out;
  }
  using Messages = std::vector<std::pair<std::uint32_t, std::uint64_t>>;

  Retained retained_{{{"/stream", {}, Keeping::none},
                      {"/map", {}, Keeping::whole},
                      {"/map/new", {}, Keeping::since_latest_map}},
                     1};
  ClientSession session_{retained_, "{\"op\":\"serverInfo\"}"};
  std::vector<json> texts_;
};

TEST_F(Session, BeginsWithTheServerAndItsChannels) {
  ClientSession session(retained_, "{\"op\":\"serverInfo\"}");
  EXPECT_EQ(json::parse(*session.next()->bytes)["op"], "serverInfo");
  EXPECT_EQ(json::parse(*session.next()->bytes)["channels"].size(), 3u);
  EXPECT_FALSE(session.next());
}

TEST_F(Session, SendsWhatIsSubscribedToAndNothingElse) {
  subscribe(40, 0);
  publish(message(0, 1));
  publish(message(1, 2));
  EXPECT_EQ(messages(), (Messages{{40, 1}}));
  session_.receive(R"({"op":"unsubscribe","subscriptionIds":[40]})");
  publish(message(0, 3));
  EXPECT_EQ(messages(), Messages{});
}

TEST_F(Session, WhatWaitsOfAnEndedSubscriptionIsNotSent) {
  subscribe(40, 0);
  publish(message(0, 1));
  session_.receive(R"({"op":"unsubscribe","subscriptionIds":[40]})");
  subscribe(41, 0);
  publish(message(0, 2));
  EXPECT_EQ(messages(), (Messages{{41, 2}}));
}

TEST_F(Session, WhoComesLaterGetsTheLastMapAndWhatWasAddedSince) {
  for (std::uint64_t t = 1; t <= 6; ++t) {
    publish(message(0, t));
    publish(message(2, t));
    if (t % 2 == 0) publish(message(1, t));
    if (t == 5) break;
  }
  subscribe(1, 1);
  subscribe(2, 2);
  subscribe(3, 0);
  EXPECT_EQ(messages(), (Messages{{1, 4}, {2, 5}}));
}

TEST_F(Session, NonsenseIsAnsweredAndAtLastReasonToLeave) {
  subscribe(1, 99);
  subscribe(1, 0);
  subscribe(1, 1);
  subscribe(2, 0);
  session_.receive(R"({"op":"unsubscribe","subscriptionIds":[77]})");
  session_.receive("garbage");
  session_.receive_binary();
  messages();
  EXPECT_EQ(texts_.size(), 6u);
  for (const json& text : texts_) EXPECT_EQ(text["level"], 2);
  EXPECT_EQ(session_.subscriptions(), 1u);
  EXPECT_EQ(session_.complaint(), "");
  for (int i = 0; i < ClientSession::kMaxRefused; ++i) session_.receive("{}");
  EXPECT_NE(session_.complaint().find("make no sense"), std::string::npos);
}

TEST_F(Session, TextsThatAreNotReadAreBounded) {
  for (std::size_t i = 0; i < ClientSession::kMaxTexts + 1; ++i) session_.tell(StatusLevel::info, "x");
  EXPECT_NE(session_.complaint(), "");
}

TEST_F(Session, WhatASlowClientMissesIsToldOnceWithTheTopics) {
  subscribe(1, 0);
  for (std::uint64_t t = 0; t < 3; ++t) publish(message(0, t, Outbox::kMaxBytes / 2));
  session_.tell_dropped();
  EXPECT_EQ(messages(), (Messages{{1, 1}, {1, 2}}));
  ASSERT_EQ(texts_.size(), 1u);
  EXPECT_NE(texts_[0]["message"].get<std::string>().find("1 of /stream"), std::string::npos) << texts_[0];
  EXPECT_EQ(session_.dropped(), 1u);
  session_.tell_dropped();
  messages();
  EXPECT_TRUE(texts_.empty());
}

TEST_F(Session, OnlyTheLatestTimeWaits) {
  for (std::uint64_t t = 1; t < 9; ++t) session_.tell_time(t);
  EXPECT_EQ(*session_.next()->bytes, time_frame(8));
  EXPECT_FALSE(session_.next());
}

}  // namespace
}  // namespace karst::live
