// What waits for a client stays within its bound, and the oldest of a topic goes first.
#include "sdk/live/outbox.h"

#include <gtest/gtest.h>

#include <random>

namespace karst::live {
namespace {

LiveMessage waiting(std::size_t topic, std::uint64_t time_ns, std::size_t bytes = 10) {
  return {topic, time_ns, std::make_shared<const std::string>(bytes, 'x')};
}

std::vector<std::uint64_t> times_of(Outbox& box) {
  std::vector<std::uint64_t> times;
  while (const auto m = box.take()) times.push_back(m->time_ns);
  return times;
}

TEST(Outbox, GivesMessagesInTheOrderOfTheirComingAcrossTopics) {
  Outbox box;
  for (std::uint64_t t = 0; t < 9; ++t) box.put(waiting(t % 3, t), Keeping::none);
  EXPECT_EQ(times_of(box), (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_TRUE(box.empty());
}

TEST(Outbox, OfATopicWhoseLastMessageSaysAllOnlyThatWaits) {
  Outbox box;
  box.put(waiting(0, 1), Keeping::whole);
  box.put(waiting(1, 2), Keeping::none);
  box.put(waiting(0, 3), Keeping::whole);
  EXPECT_EQ(times_of(box), (std::vector<std::uint64_t>{2, 3}));
  EXPECT_TRUE(box.take_dropped().empty());
}

TEST(Outbox, FullItDropsTheOldestOfTheSameTopicAndCounts) {
  Outbox box;
  const std::size_t third = Outbox::kMaxBytes / 3;
  box.put(waiting(7, 0, 100), Keeping::none);
  for (std::uint64_t t = 1; t <= 5; ++t) box.put(waiting(1, t, third), Keeping::none);
  EXPECT_EQ(times_of(box), (std::vector<std::uint64_t>{0, 4, 5}));
  EXPECT_EQ(box.take_dropped(), (std::map<std::size_t, std::uint64_t>{{1, 3}}));
  EXPECT_TRUE(box.take_dropped().empty());
}

TEST(Outbox, OneThatFindsNoRoomByItsOwnTopicTakesThatOfTheFullest) {
  Outbox box;
  for (std::uint64_t t = 0; t < 3; ++t) box.put(waiting(1, t, Outbox::kMaxBytes / 4), Keeping::none);
  box.put(waiting(2, 3, Outbox::kMaxBytes / 2), Keeping::none);
  EXPECT_EQ(times_of(box), (std::vector<std::uint64_t>{1, 2, 3}));
}

TEST(Outbox, OneMessageLargerThanAllRoomGetsIt) {
  Outbox box;
  box.put(waiting(0, 0), Keeping::none);
  box.put(waiting(1, 1, 2 * Outbox::kMaxBytes), Keeping::whole);
  EXPECT_EQ(times_of(box), (std::vector<std::uint64_t>{1}));
}

TEST(Outbox, WhateverComesItHoldsNoMoreThanItsBoundAndCountsWhatIsMissing) {
  std::mt19937 random(5);
  Outbox box;
  std::map<std::size_t, std::uint64_t> put, taken, dropped;
  for (std::uint64_t t = 0; t < 20000; ++t) {
    const std::size_t topic = random() % 4;
    box.put(waiting(topic, t, random() % 200000), Keeping::none);
    ++put[topic];
    ASSERT_LE(box.bytes(), Outbox::kMaxBytes);
    if (random() % 3 == 0)
      if (const auto m = box.take()) ++taken[m->topic];
  }
  while (const auto m = box.take()) ++taken[m->topic];
  dropped = box.take_dropped();
  for (const auto& [topic, n] : put) EXPECT_EQ(n, taken[topic] + dropped[topic]) << topic;
}

TEST(Outbox, OfSmallMessagesItHoldsNoMoreThanTheirNumber) {
  Outbox box;
  for (std::uint64_t t = 0; t < Outbox::kMaxMessages + 5; ++t) box.put(waiting(0, t, 1), Keeping::none);
  EXPECT_EQ(times_of(box).front(), 5u);
}

}  // namespace
}  // namespace karst::live
