#include "core_stack/common/executive.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

const auto kNever = [] { return false; };

TEST(Executive, RunsEventsInOrderOfTime) {
  Executive e(1);
  std::string trace;
  e.at(30, [&] { trace += 'c'; });
  e.at(10, [&] { trace += 'a'; });
  e.at(20, [&] { trace += 'b'; });
  e.run_until(100, kNever);
  EXPECT_EQ(trace, "abc");
  EXPECT_EQ(e.now(), 100);
}

TEST(Executive, SimultaneousEventsRunInOrderOfRegistration) {
  Executive e(1);
  std::string trace;
  for (char c = 'a'; c <= 'z'; ++c) e.at(5, [&trace, c] { trace += c; });
  e.run_until(5, kNever);
  EXPECT_EQ(trace, "abcdefghijklmnopqrstuvwxyz");
}

TEST(Executive, PeriodicStepsRunAtExactTimesInOrderOfRegistration) {
  Executive e(1);
  std::vector<std::pair<char, TimeNs>> trace;
  e.every("a", 0, 10, [&] { trace.emplace_back('a', e.now()); });
  e.every("b", 5, 20, [&] { trace.emplace_back('b', e.now()); });
  e.every("c", 0, 10, [&] { trace.emplace_back('c', e.now()); });
  e.run_until(30, kNever);
  const std::vector<std::pair<char, TimeNs>> expected = {{'a', 0},  {'c', 0},  {'b', 5},  {'a', 10},
                                                         {'c', 10}, {'a', 20}, {'c', 20}, {'b', 25},
                                                         {'a', 30}, {'c', 30}};
  EXPECT_EQ(trace, expected);
}

TEST(Executive, StepsOfDifferentPeriodsMeetInOrderOfRegistration) {
  // The 10 ns step was registered first, so it goes first whenever both are due, whoever re-queued itself
  // last.
  Executive e(1);
  std::string at_common_times;
  e.every("fast", 0, 10, [&] {
    if (e.now() % 30 == 0) at_common_times += 'f';
  });
  e.every("slow", 0, 30, [&] { at_common_times += 's'; });
  e.run_until(120, kNever);
  EXPECT_EQ(at_common_times, "fsfsfsfsfs");
}

TEST(Executive, StopsWhenDoneOrAtTheLimitAndCanGoOn) {
  Executive e(1);
  int count = 0;
  e.every("tick", 10, 10, [&] { ++count; });
  e.run_until(1000, [&] { return count == 3; });
  EXPECT_EQ(e.now(), 30);
  e.run_until(55, kNever);
  EXPECT_EQ(count, 5);
  EXPECT_EQ(e.now(), 55);
}

TEST(Executive, APeriodicStepThatThrowsComesAgainAtItsTime) {
  // As it was: its next turn was registered after it had run, so the first exception was the end of it.
  Executive e(1);
  std::string trace;
  e.every("fails", 10, 10, [&] {
    trace += 'f';
    if (e.now() != 20) return;
    throw std::runtime_error("once");
  });
  e.every("other", 10, 10, [&] { trace += 'o'; });
  EXPECT_THROW(e.run_until(40, kNever), std::runtime_error);
  EXPECT_EQ(e.now(), 20);
  e.run_until(40, kNever);
  EXPECT_EQ(trace, "fofofofo") << "in the order of registration, none left out";
}

TEST(Executive, CountsTheJobsUnderWayByName) {
  for (const int threads : {1, 2}) {
    Executive e(threads);
    e.job(
        "scan", Lane::map, 10, [] {}, [] {});
    e.job(
        "scan", Lane::map, 20, [] { throw std::runtime_error("fails"); }, [] {});
    EXPECT_EQ(e.under_way("scan"), 2);
    EXPECT_EQ(e.under_way("plan"), 0);
    e.run_until(10, kNever);
    EXPECT_EQ(e.under_way("scan"), 1);
    EXPECT_THROW(e.run_until(20, kNever), std::runtime_error);
    EXPECT_EQ(e.under_way("scan"), 0) << "what failed is not waited for";
  }
}

TEST(Executive, NothingRunsBeforeNow) {
  Executive e(1);
  e.run_until(100, kNever);
  TimeNs ran = -1;
  e.at(20, [&] { ran = e.now(); });
  e.run_until(200, kNever);
  EXPECT_EQ(ran, 100);
}

class ExecutiveThreads : public testing::TestWithParam<int> {};

TEST_P(ExecutiveThreads, ResultsArePublishedExactlyAtTheEndOfTheBudget) {
  Executive e(GetParam());
  TimeNs published = -1;
  int result = 0, seen = 0;
  e.at(7, [&] {
    e.job(
        "work", Lane::map, 50, [&] { result = 42; }, [&] { published = e.now(), seen = result; });
  });
  e.run_until(56, kNever);
  EXPECT_EQ(published, -1);
  e.run_until(57, kNever);
  EXPECT_EQ(published, 57);
  EXPECT_EQ(seen, 42);
  EXPECT_EQ(e.costs().at("work").duration.count(), 1u);
}

TEST_P(ExecutiveThreads, JobsOfOneLaneRunInTheOrderSubmitted) {
  Executive e(GetParam());
  std::vector<int> order;  // no lock: one lane runs one job at a time
  for (int i = 0; i < 200; ++i)
    e.job(
        "work", Lane::sensing, 1000 - i, [&order, i] { order.push_back(i); }, [] {});
  e.run_until(2000, kNever);
  ASSERT_EQ(order.size(), 200u);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

TEST_P(ExecutiveThreads, AnExceptionInWorkIsRethrownWhenItWouldBePublished) {
  Executive e(GetParam());
  bool published = false;
  e.job(
      "bad", Lane::map, 30, [] { throw std::runtime_error("map is full"); }, [&] { published = true; });
  e.run_until(29, kNever);
  try {
    e.run_until(100, kNever);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "map is full");
  }
  EXPECT_EQ(e.now(), 30);
  EXPECT_FALSE(published);
  int later = 0;
  e.job(
      "good", Lane::map, 10, [] {}, [&] { ++later; });
  e.run_until(100, kNever);
  EXPECT_EQ(later, 1) << "the lane goes on after an exception";
}

TEST_P(ExecutiveThreads, DrainFinishesTheWorkAndPublishesNothing) {
  Executive e(GetParam());
  int sensed = 0, mapped = 0, published = 0;
  for (int i = 0; i < 20; ++i) {
    e.job(
        "sense", Lane::sensing, 100, [&] { ++sensed; }, [&] { ++published; });
    e.job(
        "map", Lane::map, 100, [&] { ++mapped; }, [&] { ++published; });
  }
  e.drain();
  EXPECT_EQ(sensed, 20);
  EXPECT_EQ(mapped, 20);
  EXPECT_EQ(published, 0);
  for (const Lane lane : {Lane::sensing, Lane::map}) {
    int after = 0;
    e.job(
        "work", lane, 1, [&] { ++after; }, [] {});
    e.drain();
    EXPECT_EQ(after, 1) << "the lanes work again";
  }
}

TEST_P(ExecutiveThreads, PublishedResultsKeepTheirPlaceAmongEventsOfTheSameTime) {
  Executive e(GetParam());
  std::string trace;
  e.at(10, [&] { trace += 'a'; });
  e.job(
      "j", Lane::map, 10, [] {}, [&] { trace += 'j'; });
  e.at(10, [&] { trace += 'b'; });
  e.run_until(10, kNever);
  EXPECT_EQ(trace, "ajb");
}

TEST(Executive, HasAThreadForEachLaneOrOnlyTheLoops) {
  for (const int few : {-1, 0, 1}) EXPECT_EQ(Executive(few).threads(), 1);
  for (const int more : {2, 3, 200}) EXPECT_EQ(Executive(more).threads(), 5);
}

INSTANTIATE_TEST_SUITE_P(OneAndTwo, ExecutiveThreads, testing::Values(1, 3));

/// A small pipeline: sensing jobs feed map jobs, which feed an estimate that later work depends on.
std::vector<std::uint64_t> pipeline_trace(int threads, bool sleepy) {
  Executive e(threads);
  std::vector<std::uint64_t> trace;
  Random delays(threads);
  std::uint64_t map = 1, estimate = 0;
  const auto pause = [&](double up_to_us) {
    if (!sleepy) return std::chrono::microseconds(0);
    return std::chrono::microseconds(static_cast<int>(delays.uniform(0, up_to_us)));
  };
  e.every("scan", 0, 100, [&] {
    const auto scan = std::make_shared<std::uint64_t>(estimate + static_cast<std::uint64_t>(e.now()));
    const auto nap = pause(400), longer_nap = pause(900);
    e.job(
        "filter", Lane::sensing, 40,
        [scan, nap] {
          std::this_thread::sleep_for(nap);
          *scan = Random(*scan).bits();
        },
        [&, scan, longer_nap] {
          trace.push_back(*scan);
          e.job(
              "map", Lane::map, 170,
              [&map, scan, longer_nap] {
                std::this_thread::sleep_for(longer_nap);
                map = Random(map ^ *scan).bits();
              },
              [&, scan] {
                // The map may be a job further already: what was computed travels with the job.
                estimate ^= *scan;
                trace.push_back(estimate);
                trace.push_back(static_cast<std::uint64_t>(e.now()));
              });
        });
  });
  e.every("control", 0, 10, [&] { estimate = Random(estimate).bits(), trace.push_back(estimate); });
  e.run_until(10000, kNever);
  e.drain();
  trace.push_back(map);
  return trace;
}

TEST(Executive, TheTraceIsTheSameForAnyNumberOfThreadsAndAnyDelay) {
  const auto reference = pipeline_trace(1, false);
  EXPECT_GT(reference.size(), 1200u);
  EXPECT_EQ(pipeline_trace(2, false), reference);
  EXPECT_EQ(pipeline_trace(2, true), reference);
  EXPECT_EQ(pipeline_trace(2, true), reference);
}

}  // namespace
}  // namespace karst::core
