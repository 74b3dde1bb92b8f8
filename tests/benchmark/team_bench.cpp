// What a team's radio traffic costs, and how long choosing a landing place takes. Times are processor times.
#include <cstdio>
#include <limits>

#include "core_stack/team/communication/relay_graph.h"
#include "core_stack/team/relay_homing.h"
#include "tests/benchmark/times.h"
#include "tests/unit/planning/test_maps.h"
#include "tests/unit/team/communication/lossy_network.h"

namespace karst::core {
namespace {

using bench::cpu_ms;
using testing::Network;

/// A chain of robots that each publish 100 records of 18 bytes in 100 s: until all hold all, and at rest.
void gossip(RobotId n, double loss, double corruption) {
  Network net(
      n, [](RobotId a, RobotId b, TimeNs) { return a + 1 == b || b + 1 == a; }, loss, corruption, 7);
  double ms = 0;
  for (std::uint32_t k = 1; k <= 100; ++k) {
    for (Gossip& r : net.robots) r.publish(ObjectSeen{k * kSecond, k, r.self(), {1.0 * k, 2, 3}, 0.5});
    ms += cpu_ms([&] { net.run(1); });
  }
  double late_s = 0;
  for (; !net.alike() && late_s < 600; ++late_s) ms += cpu_ms([&] { net.run(1); });
  const double all_s = seconds(net.now), bytes = static_cast<double>(net.bytes);
  net.run(100);
  std::printf(
      "  %2d in a chain, %2.0f %% lost, %2.0f %% corrupted: all hold all %3.0f s after the last word; %4.0f "
      "bytes/s a "
      "robot, at rest %3.0f; %.2f ms of work a second for all\n",
      n, 100 * loss, 100 * corruption, late_s, bytes / all_s / n,
      (static_cast<double>(net.bytes) - bytes) / 100 / n, ms / all_s);
}

void messages() {
  TreeFacts facts;
  facts.nodes = {{{3, 120}, NodeKind::pose, {103.4, -22.1, 3.2}}};
  for (std::uint32_t i = 0; i < 7; ++i) facts.rays.push_back({{3, 120}, {3, 119 - i}, true, 250 * kSecond});
  const Bytes record = *write_record(facts);
  const Bytes frame =
      *testing::write_frame({.sender = 3, .records = {{3, 1, record}, {3, 2, record}, {3, 3, record}}});
  constexpr int kTimes = 200000;
  std::size_t sum = 0;
  Refusal why{};
  const double read_ms = cpu_ms([&] {
    for (int i = 0; i < kTimes; ++i) sum += testing::read_frame(frame, why)->records.size();
  });
  const double record_ms = cpu_ms([&] {
    for (int i = 0; i < kTimes; ++i) sum += std::get<TreeFacts>(*read_record(record, why)).rays.size();
  });
  std::printf(
      "a pose node with 7 rays: %zu bytes; frame of %zu bytes read in %.2f us, the record in %.2f us (%zu)\n",
      record.size(), frame.size(), 1e3 * read_ms / kTimes, 1e3 * record_ms / kTimes, sum);
}

/// A robot flies away from the base, which hears it over the whole way.
void landing() {
  const testing::WindingCave cave = testing::WindingCave::of_length(200, 3, 2.2);
  std::vector<CellChange> changes;
  const VoxelMap map = cave.map(&changes);
  const PlanningOptions planning;
  const MotionLimits limits;
  Roadmap roadmap{planning};
  roadmap.update(map, changes);
  HomingOptions options;
  options.landing.link.range_m = 1000, options.landing.link.rock_db_per_m = 0;
  const Vec3 base = cave.line.front();
  RelayHoming homing(1, {{}, options, planning, limits, 0.3, base});
  TeamNews news;
  news.relays = {{kBase, base, base}};
  bench::Times update, nearest, gets_by;
  for (const Vec3& p : cave.line) {
    update.ms.push_back(cpu_ms([&] { homing.update(map, roadmap, p, news, {}); }));
    nearest.ms.push_back(
        cpu_ms([&] { homing.spot_from(map, roadmap, p, std::numeric_limits<double>::infinity()); }));
    gets_by.ms.push_back(cpu_ms([&] { keeps_passage_open(map, p, 0.3 + kAsMapped_m, 0.55, 3); }));
  }
  std::printf("landing places along 200 m of a winding passage, each second\n");
  update.print("what is new is taken in, ground judged, links asked for");
  nearest.print("the nearest place");
  gets_by.print("do others get by one place");
}

void run() {
  messages();
  std::printf("gossip, 100 records a robot in 100 s\n");
  for (const RobotId n : {RobotId{5}, RobotId{10}}) {
    gossip(n, 0, 0);
    gossip(n, 0.3, 0);
    gossip(n, 0.3, 0.5);
  }
  landing();
}

}  // namespace
}  // namespace karst::core

int main() { karst::core::run(); }
