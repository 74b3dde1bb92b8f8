// deadlines: the duration of calls. Judged by processor time of the deciding thread, which does not depend on
// the machine's load; the parent detects a call that never returns.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "sdk/check/flight.h"
#include "sdk/check/tests.h"
#include "sdk/check/watched_host.h"

namespace karst::check {
namespace {

using Of = Test::Of;

constexpr double kBudget_s = 0.3;  // default simulated time for a decision and its plan
constexpr double kLargeLimit_s =
    2.0;  // far below the hang limit, and a vehicle that flies on can wait for it

double round_ms(double s) { return std::round(s * 1e5) / 100; }

void require_time(Context& c, const std::vector<Answer>& answers, double limit_s) {
  std::vector<double> times_s;
  for (const Answer& a : answers) times_s.push_back(a.cpu_s);
  std::sort(times_s.begin(), times_s.end());
  double longest_wall_s = 0;
  for (const Answer& a : answers) longest_wall_s = std::max(longest_wall_s, a.wall_s);
  c.figures["decisions"] = times_s.size();
  c.figures["p50_ms"] = round_ms(times_s[times_s.size() / 2]);
  c.figures["max_ms"] = round_ms(times_s.back());
  c.figures["max_wall_ms"] = round_ms(longest_wall_s);
  if (times_s.back() <= limit_s) return;
  throw Failed{"a decision took " + std::to_string(static_cast<int>(1000 * times_s.back())) +
               " ms of processor time, " + std::to_string(static_cast<int>(1000 * limit_s)) +
               " ms are allowed"};
}

void fly_in(Context& c, const CaveShape& shape, int decisions, double limit_s) {
  const auto session = new_session(c);
  Flight flight(c.seed, shape, 0.9);
  c.figures["free_m3"] = std::round(flight.cave().map().free_volume_m3());
  const auto object = started(c, *session);
  require_time(c, fly(*object, flight, decisions), limit_s);
}

void small(Context& c) { fly_in(c, {.volume_m3 = 1100, .radius_m = 2.0, .branches = 5}, 15, kBudget_s); }
void large(Context& c) { fly_in(c, {.volume_m3 = 25000, .radius_m = 4.5, .branches = 7}, 6, kLargeLimit_s); }

void should_stop(Context& c) {
  const auto session = new_session(c);
  WatchedHost host(*session->host());
  Flight flight(c.seed, {.volume_m3 = 1100, .radius_m = 2.0, .branches = 5}, 0.9);
  const auto object = started(c, *session, host.host());
  require(object->decide(flight.request()).failure);
  host.stopping = true;
  host.before = [](const char*) { return std::int32_t{KARST_ERROR_ABANDONED}; };
  const Answer given_up = object->decide(flight.request());  // any answer is accepted
  c.figures["returned_after_ms"] = round_ms(given_up.wall_s);
  if (given_up.failure.find("exception across the border") != std::string::npos)
    throw Failed{given_up.failure};
  if (given_up.cpu_s > kBudget_s)
    throw Failed{"told to stop from the start, it went on for " +
                 std::to_string(static_cast<int>(1000 * given_up.cpu_s)) + " ms"};
}

}  // namespace

std::vector<Test> deadline_tests() {
  return {
      {"deadlines.small", Level::strict, Of::policy,
       "In 1,000 m³ of known cave no decision takes more than 300 ms of processor time.", small},
      {"deadlines.large", Level::basic, Of::policy,
       "In 20,000 m³ of known cave no decision takes more than 2 s of processor time.", large},
      {"deadlines.should_stop", Level::basic, Of::policy,
       "It returns at once when the host says stop and all services fail.", should_stop},
  };
}

}  // namespace karst::check
