// memory: peak use, growth, and release.
#include "sdk/check/flight.h"
#include "sdk/check/process_view.h"
#include "sdk/check/tests.h"

namespace karst::check {
namespace {

using Of = Test::Of;

constexpr double kGrowthLimit_bytes = 4096;  // per decision: a mission of an hour then takes 15 MB
constexpr double kLifeLimit_bytes = 1024;    // per object
constexpr std::size_t kPeakLimit_bytes = 512u << 20;

double difference(std::size_t now, std::size_t before) {
  return static_cast<double>(now) - static_cast<double>(before);
}

void growth(Context& c) {
  constexpr int warm = 60, measured = 240;
  const auto session = new_session(c);
  Flight flight(c.seed, {.volume_m3 = 100, .radius_m = 1.6, .branches = 2}, 0.5);
  flight.map_grows = false;
  const auto object = started(c, *session);
  for (int i = 0; i < warm; ++i) fly(*object, flight, 1);
  const std::size_t before = heap_bytes();
  for (int i = 0; i < measured; ++i) fly(*object, flight, 1);
  const double bytes = difference(heap_bytes(), before) / measured;
  c.figures["bytes_a_decision"] = static_cast<long>(bytes);
  if (bytes > kGrowthLimit_bytes)
    throw Failed{"the heap grows by " + std::to_string(static_cast<long>(bytes)) + " bytes a decision, " +
                 std::to_string(static_cast<long>(kGrowthLimit_bytes)) + " are allowed"};
}

void returned(Context& c) {
  constexpr int warm = 3, measured = 20;
  Flight flight(c.seed, {.volume_m3 = 100, .radius_m = 1.6, .branches = 2}, 0.5);
  flight.map_grows = false;
  const auto live = [&] {
    const auto session = new_session(c);
    const auto object = started(c, *session);
    fly(*object, flight, 2);
    require(object->deactivate());
  };
  for (int i = 0; i < warm; ++i) live();
  const std::size_t before = heap_bytes();
  for (int i = 0; i < measured; ++i) live();
  const double bytes = difference(heap_bytes(), before) / measured;
  c.figures["bytes_an_object"] = static_cast<long>(bytes);
  if (bytes > kLifeLimit_bytes)
    throw Failed{"each object leaves " + std::to_string(static_cast<long>(bytes)) + " bytes behind"};
}

void peak(Context& c) {
  const auto session = new_session(c);
  Flight flight(c.seed, {.volume_m3 = 25000, .radius_m = 4.5, .branches = 7}, 0.9);
  flight.request();
  const auto object = started(c, *session);
  reset_peak();
  const std::size_t before = resident_bytes();
  for (int i = 0; i < 3; ++i) require(object->decide(flight.request()).failure);
  const std::size_t most = peak_bytes(), taken = most > before ? most - before : 0;
  c.figures["MiB"] = taken >> 20;
  if (taken > kPeakLimit_bytes)
    throw Failed{"deciding on 20,000 m³ it takes " + std::to_string(taken >> 20) + " MiB, " +
                 std::to_string(kPeakLimit_bytes >> 20) + " are allowed"};
}

}  // namespace

std::vector<Test> memory_tests() {
  return {
      {"memory.growth", Level::strict, Of::policy,
       "Over many decisions the heap grows by less than 4 KiB each.", growth},
      {"memory.returned", Level::strict, Of::policy, "A destroyed object leaves nothing on the heap.",
       returned},
      {"memory.peak", Level::basic, Of::policy, "Deciding on 20,000 m³ it takes no more than 512 MiB.", peak},
  };
}

}  // namespace karst::check
