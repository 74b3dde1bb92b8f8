// One plugin, many policies: `good`, and for each test of `karst policy check` one that must fail it. The
// comment of each class names that test.
#include <fcntl.h>
#include <time.h>

#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <thread>

#include "tests/check/plugins/good.h"

namespace karst::test {
namespace {

using karst::Decision;
using karst::Request;

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
void work_for(double cpu_s) {
  for (const double end = seconds(CLOCK_THREAD_CPUTIME_ID) + cpu_s; seconds(CLOCK_THREAD_CPUTIME_ID) < end;)
    continue;
}
[[noreturn]] void give_up(const char* why) { throw karst::Error(why); }

/// The good policy's answer with its goals changed.
template <class Change>
Decision changed(Decision d, Change&& change) {
  for (karst::Goal& g : d.goals) change(g);
  return d;
}

struct CrashesInDestroy : Good {  // lifecycle.destroy: only if it was never initialized
  void init() override { initialized = true; }
  ~CrashesInDestroy() override {
    if (made_by_host && !initialized) std::abort();
  }
  bool initialized = false;
  // The first object of the process is made to learn the parameters, not by the host.
  static inline int objects = 0;
  bool made_by_host = ++objects > 1;
};
struct ActivatesOnce : Good {  // lifecycle.reactivate
  void activate() override {
    if (++times > 1) give_up("active before");
  }
  int times = 0;
};
struct AfraidOfNews : Good {  // lifecycle.events
  void on_event(const karst::Event& e) override {
    if (e.kind > KARST_EVENT_MAP_MERGED) give_up("unknown kind of event");
  }
};
struct SharesMemory : Good {  // lifecycle.two_objects
  ~SharesMemory() override { last = nullptr; }
  Decision decide(const Request& r) override {
    const bool alone = last == nullptr || last == this;
    last = this;
    return alone ? Good::decide(r) : Decision::hold("confused");
  }
  static inline const void* last = nullptr;
};
struct BreaksAtBound : Good {  // parameters.bounds
  Decision decide(const Request& r) override {
    return reach_m_ < 100 ? Good::decide(r) : throw karst::Error("too far");
  }
};
struct BreaksOnText : Good {  // parameters.texts
  void init() override {
    if (label_.size() > 500) std::abort();
  }
};
struct NeedsFrontier : Good {  // requests.no_frontier
  Decision decide(const Request& r) override {
    if (r.frontiers.empty()) give_up("no frontier");
    return Good::decide(r);
  }
};
struct NeedsTwo : Good {  // requests.one_frontier
  Decision decide(const Request& r) override {
    if (r.frontiers.size() == 1) give_up("only one frontier");
    return Good::decide(r);
  }
};
struct NeedsFew : Good {  // requests.thousands
  Decision decide(const Request& r) override {
    if (r.frontiers.size() > 1000) give_up("too many frontiers");
    return Good::decide(r);
  }
};
struct NeedsMap : Good {  // requests.empty_map
  Decision decide(const Request& r) override {
    if (r.map.info().free_cells == 0) give_up("empty map");
    return Good::decide(r);
  }
};
struct NeedsTime : Good {  // requests.extremes
  Decision decide(const Request& r) override {
    if (r.seconds_before_homing < -1000) give_up("late");
    return Good::decide(r);
  }
};
struct SeldomFails : Good {  // requests.fuzzed
  Decision decide(const Request& r) override {
    const double speed_mps = karst::norm(r.state.velocity);
    if (speed_mps > 0 && speed_mps < 100) give_up("moving");
    return Good::decide(r);
  }
};
struct NoTolerance : Good {  // goals.well_formed
  Decision decide(const Request& r) override {
    return changed(Good::decide(r), [](karst::Goal& g) { g.tolerance_m = 0; });
  }
};
struct IntoTheRock : Good {  // goals.inside
  Decision decide(const Request& r) override {
    return changed(Good::decide(r), [](karst::Goal& g) { g.position.z += 30; });
  }
};
struct Unranked : Good {  // goals.ranked
  Decision decide(const Request& r) override {
    return changed(Good::decide(r), [](karst::Goal& g) { g.score = -g.score; });
  }
};
struct Mute : Good {  // goals.reasons
  Decision decide(const Request& r) override {
    return changed(Good::decide(r), [](karst::Goal& g) { g.why.clear(); });
  }
};
struct Forgets : Good {  // state.same_answers
  void memory(karst::Memory&) override {}
};
struct Bloated : Good {  // state.size
  void memory(karst::Memory& m) override { m.add(decisions_), m.add(ballast); }
  std::string ballast = std::string(2u << 20, 'x');
};
struct ReadsTheClock : Good {  // determinism.repeat
  Decision decide(const Request& r) override {
    return changed(Good::decide(r), [](karst::Goal& g) { g.heading_rad = seconds(CLOCK_MONOTONIC); });
  }
};
struct ReadsAddresses : Good {  // determinism.fresh_process
  Decision decide(const Request& r) override {
    static const int somewhere = 0;
    return changed(Good::decide(r), [](karst::Goal& g) {
      g.heading_rad = static_cast<double>(reinterpret_cast<std::uintptr_t>(&somewhere));
    });
  }
};
struct LosesPatience : Good {  // determinism.slow_host
  Decision decide(const Request& r) override {
    const double begin_s = seconds(CLOCK_MONOTONIC);
    r.map.info();
    return seconds(CLOCK_MONOTONIC) - begin_s > 0.045 ? Decision::hold("too slow") : Good::decide(r);
  }
};
struct Slow : Good {  // deadlines.small
  Decision decide(const Request& r) override {
    if (!r.should_stop() && r.map.info().free_cells > 100'000) work_for(0.5);
    return Good::decide(r);
  }
};
struct VerySlow : Good {  // deadlines.large
  Decision decide(const Request& r) override {
    if (r.map.info().free_cells > 1'000'000) work_for(2.5);
    return Good::decide(r);
  }
};
struct Deaf : Good {  // deadlines.should_stop: tries again until it works
  Decision decide(const Request& r) override {
    for (;;) try {
        r.map.info();
        return Good::decide(r);
      } catch (const karst::Error&) {
      }
  }
};
struct OnAnotherThread : Good {  // services.rules
  Decision decide(const Request& r) override {
    std::thread([&r] {
      try {
        r.draw_points({{0, 0, 0}}, 0);
      } catch (const karst::Error&) {
      }
    }).join();
    return Good::decide(r);
  }
};
struct Resentful : Good {  // services.fail
  Decision decide(const Request& r) override {
    if (hurt) give_up("it failed before");
    hurt = true;
    Decision d = Good::decide(r);
    hurt = false;
    return d;
  }
  bool hurt = false;
};
struct LeavesThread : Good {  // threads.end
  void activate() override {
    std::thread([] {
      for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
    }).detach();
  }
};
struct Leaks : Good {  // memory.growth
  Decision decide(const Request& r) override {
    lost = new char[20'000];
    return Good::decide(r);
  }
  char* volatile lost = nullptr;
};
struct LeaksObjects : Good {  // memory.returned
  void init() override { lost = new char[20'000]; }
  char* volatile lost = nullptr;
};
struct Hog : Good {  // memory.peak
  Decision decide(const Request& r) override {
    if (r.map.info().free_cells > 1'000'000) {
      std::vector<char> all(700u << 20, 'x');
      if (all[static_cast<std::size_t>(decisions_)] != 'x') give_up("lost some");
    }
    return Good::decide(r);
  }
};
struct Talks : Good {  // process.output
  Decision decide(const Request& r) override {
    std::puts("here I am");
    return Good::decide(r);
  }
};
struct ChangesLocale : Good {  // process.locale_and_arithmetic
  Decision decide(const Request& r) override {
    std::setlocale(LC_ALL, "C.UTF-8");
    return Good::decide(r);
  }
};
struct TakesSignal : Good {  // process.signals
  void activate() override { std::signal(SIGINT, SIG_IGN); }
};
struct LeavesFile : Good {  // process.leftovers
  void activate() override {
    if (open("/dev/null", O_RDONLY) < 0) give_up("no file");
  }
};

/// The good policy's table with something in it changed.
template <class Tag, class Change>
const karst_policy_t* changed_table(const char* id, Change&& change) {
  struct Policy : Good {};
  static const karst_policy_t table = [&] {
    karst_policy_t t = *border::entry<Policy>(id, "1.0.0", "Spoiled.");
    change(t);
    return t;
  }();
  return &table;
}

/// state.extensions
const karst_policy_t* knows_everything() {
  return changed_table<struct A>("knows_everything", [](karst_policy_t& t) {
    t.extension = [](void*, karst_text_t) noexcept -> const void* {
      static const karst_state_extension_t nothing{sizeof nothing, 0, nullptr, nullptr};
      return &nothing;
    };
  });
}
/// state.damage: believes a length it reads.
const karst_policy_t* trusts_bytes() {
  return changed_table<struct B>("trusts_bytes", [](karst_policy_t& t) {
    t.extension = [](void*, karst_text_t id) noexcept -> const void* {
      static const karst_state_extension_t table{
          sizeof table, 0,
          [](void*, const karst_state_sink_t* sink, karst_error_t* e) noexcept {
            const std::uint64_t length = 16;
            return sink->write(sink, &length, sizeof length, e);
          },
          [](void*, const void* bytes, std::uint64_t count, karst_error_t*) noexcept -> std::int32_t {
            std::uint64_t length = 16;
            std::memcpy(&length, bytes, std::min<std::uint64_t>(count, sizeof length));
            if (length != 16) std::abort();  // as a read far outside would end
            return KARST_OK;
          }};
      return id.length == sizeof KARST_STATE_EXTENSION - 1 ? &table : nullptr;
    };
  });
}
/// services.absent: asks for a gain without looking whether there is one.
const karst_host_t* host_of_needs_gain = nullptr;
void* (*good_create)(const karst_host_t*, karst_error_t*) noexcept = nullptr;
std::int32_t (*good_activate)(void*, karst_error_t*) noexcept = nullptr;
const karst_policy_t* needs_gain() {
  return changed_table<struct C>("needs_gain", [](karst_policy_t& t) {
    good_create = t.create, good_activate = t.activate;
    t.create = [](const karst_host_t* host, karst_error_t* e) noexcept {
      host_of_needs_gain = host;
      return good_create(host, e);
    };
    t.activate = [](void* self, karst_error_t* e) noexcept {
      std::uint64_t out = 0;
      host_of_needs_gain->gain->newly_seen(host_of_needs_gain, nullptr, nullptr, 0, nullptr, 0, &out, e);
      return good_activate(self, e);
    };
  });
}

}  // namespace
}  // namespace karst::test

#define SPOILED(Type, id) karst::border::entry<karst::test::Type>(id, "1.0.0", "Spoiled.")
KARST_PLUGIN(SPOILED(Good, "good"), SPOILED(CrashesInDestroy, "crashes_in_destroy"),
             SPOILED(ActivatesOnce, "activates_once"), SPOILED(AfraidOfNews, "afraid_of_news"),
             SPOILED(SharesMemory, "shares_memory"), SPOILED(BreaksAtBound, "breaks_at_bound"),
             SPOILED(BreaksOnText, "breaks_on_text"), SPOILED(NeedsFrontier, "needs_frontier"),
             SPOILED(NeedsTwo, "needs_two"), SPOILED(NeedsFew, "needs_few"), SPOILED(NeedsMap, "needs_map"),
             SPOILED(NeedsTime, "needs_time"), SPOILED(SeldomFails, "seldom_fails"),
             SPOILED(NoTolerance, "no_tolerance"), SPOILED(IntoTheRock, "into_the_rock"),
             SPOILED(Unranked, "unranked"), SPOILED(Mute, "mute"), SPOILED(Forgets, "forgets"),
             SPOILED(Bloated, "bloated"), SPOILED(ReadsTheClock, "reads_the_clock"),
             SPOILED(ReadsAddresses, "reads_addresses"), SPOILED(LosesPatience, "loses_patience"),
             SPOILED(Slow, "slow"), SPOILED(VerySlow, "very_slow"), SPOILED(Deaf, "deaf"),
             SPOILED(OnAnotherThread, "on_another_thread"), SPOILED(Resentful, "resentful"),
             SPOILED(LeavesThread, "leaves_thread"), SPOILED(Leaks, "leaks"),
             SPOILED(LeaksObjects, "leaks_objects"), SPOILED(Hog, "hog"), SPOILED(Talks, "talks"),
             SPOILED(ChangesLocale, "changes_locale"), SPOILED(TakesSignal, "takes_signal"),
             SPOILED(LeavesFile, "leaves_file"), karst::test::knows_everything(), karst::test::trusts_bytes(),
             karst::test::needs_gain())
