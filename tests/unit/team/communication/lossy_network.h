// Robots that gossip on a network that loses and corrupts frames.
#pragma once
#include <functional>

#include "core_stack/team/communication/gossip.h"
#include "tests/unit/team/communication/test_radio.h"

namespace karst::core::testing {

using Heard = std::function<bool(RobotId from, RobotId to, TimeNs now)>;

struct Network {
  std::vector<Gossip> robots;
  Heard linked;
  double loss, corruption;
  Random random;
  std::vector<std::vector<Delivery>> delivered;
  TimeNs now = 0;
  std::uint64_t bytes = 0;
  TeamPhase phase = TeamPhase::explore;

  Network(RobotId n, Heard l, double lose, double corrupt, std::uint64_t seed)
      : linked(std::move(l)), loss(lose), corruption(corrupt), random(seed), delivered(n) {
    for (RobotId i = 0; i < n; ++i) robots.emplace_back(radio(i), GossipOptions{}, seed + i);
  }
  void run(double for_s) {
    for (const TimeNs end = now + from_seconds(for_s); now < end; now += kSecond / 10) {
      std::vector<std::pair<RobotId, Bytes>> air;
      for (Gossip& r : robots) {
        TeamState state;
        state.stamp = now;
        state.seconds_left = 100;
        state.phase = r.self() == kBase ? TeamPhase::standby : phase;
        r.set_state(state);
        for (Bytes& b : r.send(now)) air.push_back({r.self(), std::move(b)});
      }
      for (const auto& [from, frame] : air) {
        bytes += frame.size();
        for (Gossip& to : robots) {
          if (to.self() == from || !linked(from, to.self(), now) || random.uniform() < loss) continue;
          Bytes copy = frame;
          if (random.uniform() < corruption) {
            for (int k = 0; k < 3; ++k)
              copy[random.bits() % copy.size()] ^= static_cast<std::uint8_t>(1u << random.bits() % 8);
            if (random.uniform() < 0.3) copy.resize(random.bits() % copy.size());
          }
          to.receive(copy, now);
        }
      }
      for (Gossip& r : robots)
        for (Delivery& d : r.take_delivered()) delivered[r.self()].push_back(std::move(d));
    }
  }
  bool alike() const {
    for (const Gossip& r : robots)
      for (RobotId a = 0; a < robots.size(); ++a)
        if (r.held(a).first() != robots[a].held(a).first()) return false;
    return true;
  }
};

}  // namespace karst::core::testing
