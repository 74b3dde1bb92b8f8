#include "core_stack/common/stall_watch.h"

#include <gtest/gtest.h>

#include <future>

namespace karst::core {
namespace {

using std::chrono::milliseconds;

TEST(StallWatch, NamesTheStepThatDoesNotReturn) {
  for (const char* hangs : {"control", "mapping"}) {
    Executive executive(2);
    std::promise<std::string> reported;
    // What hangs goes on once it was noticed, so the test ends as soon as that.
    std::shared_future<std::string> notice = reported.get_future().share();
    executive.every("control", 10, 10, [&] {
      if (executive.now() != 20) return;
      if (std::string(hangs) == "control") notice.wait();
      executive.job(
          "mapping", Lane::map, 5, [&] { notice.wait(); }, [] {});
    });
    StallWatch watch({&executive}, milliseconds(1000),
                     [&](const std::string& what) { reported.set_value(what); });
    executive.run_until(100, [] { return false; });
    EXPECT_EQ(notice.get(), hangs);
  }
}

TEST(StallWatch, OfATeamNamesTheRobotsStepThatHoldsUpTheOthers) {
  Executive first(1), second(1);
  std::promise<std::string> reported;
  std::shared_future<std::string> notice = reported.get_future().share();
  first.every("mapping", 10, 10, [] {});
  second.every("control", 10, 10, [&] {
    if (second.now() == 50) notice.wait();
  });
  StallWatch watch({&first, &second}, milliseconds(1000),
                   [&](const std::string& what) { reported.set_value(what); });
  for (TimeNs t = 20; t <= 100; t += 20)
    for (Executive* e : {&first, &second}) e->run_until(t, [] { return false; });
  EXPECT_EQ(notice.get(), "control");
}

TEST(StallWatch, EndsWithItsMakerWithoutAReport) {
  Executive executive(1);
  int reports = 0;
  {
    const StallWatch watch({&executive}, std::chrono::hours(1), [&](const std::string&) { ++reports; });
  }
  EXPECT_EQ(reports, 0);
}

}  // namespace
}  // namespace karst::core
