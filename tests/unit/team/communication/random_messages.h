// Messages of every kind with numbers that can be written exactly.
#pragma once
#include "core_stack/common/random.h"
#include "core_stack/team/communication/messages.h"

namespace karst::core::testing {

inline std::uint32_t below(Random& r, std::uint32_t n) { return static_cast<std::uint32_t>(r.bits() % n); }
inline TimeNs random_time(Random& r) { return static_cast<TimeNs>(r.bits() >> 32) * kMillisecond; }
inline Vec3 random_place(Random& r) {
  const double x = r.uniform(-300, 300), y = r.uniform(-4e4, 4e4), z = r.uniform(-50, 50);
  return to_centimetres({x, y, z});
}
inline NodeId random_id(Random& r) {
  return {static_cast<RobotId>(below(r, kMaxRobots)), below(r, r.uniform() < 0.8 ? 300 : kMaxNumber)};
}

inline TreeFacts random_facts(Random& r, std::uint32_t most) {
  TreeFacts f;
  for (std::uint32_t n = below(r, most + 1); n > 0; --n)
    f.nodes.push_back({random_id(r), static_cast<NodeKind>(below(r, 2)), random_place(r)});
  for (std::uint32_t n = below(r, 4 * most + 1); n > 0; --n) {
    RayFact ray{random_id(r), random_id(r), r.uniform() < 0.7, random_time(r)};
    if (!f.rays.empty() && r.uniform() < 0.7) ray.a = f.rays.back().a, ray.stamp = f.rays.back().stamp;
    if (ray.a != ray.b) f.rays.push_back(ray);
  }
  for (std::uint32_t n = below(r, 3); n > 0; --n)
    f.lives.push_back({random_id(r), r.uniform() < 0.5, random_time(r)});
  return f;
}

inline Record random_record(Random& r) {
  switch (below(r, std::variant_size_v<Record>)) {
    case 0:
      return random_facts(r, 2);
    case 1:
      return GoalClaim{random_time(r), random_place(r), r.uniform() < 0.5};
    case 2:
      return LandingClaim{random_time(r), random_place(r), random_place(r),
                          static_cast<LandingClaim::State>(below(r, 3))};
    case 3:
      return ObjectSeen{random_time(r), below(r, kMaxNumber), static_cast<std::uint8_t>(below(r, 256)),
                        random_place(r), 0.1 * below(r, 256)};
    default:
      break;
  }
  Receipt receipt;
  for (std::uint32_t n = below(r, kMaxRobots + 1); n > 0; --n)
    receipt.rows.push_back({static_cast<RobotId>(below(r, kMaxRobots)), below(r, kMaxNumber)});
  return receipt;
}

inline TeamState random_state(Random& r) {
  TeamState s;
  s.robot = static_cast<RobotId>(below(r, kMaxRobots));
  s.stamp = random_time(r), s.position = random_place(r), s.velocity_mps = random_place(r) / 1000;
  s.velocity_mps = (s.velocity_mps * 100).array().round() / 100;
  s.phase = static_cast<TeamPhase>(below(r, 9));
  s.seconds_left = below(r, 65536);
  for (std::uint32_t n = below(r, 6); n > 0; --n)
    s.heard.push_back({static_cast<RobotId>(below(r, kMaxRobots)), below(r, 256) / 255.0});
  return s;
}

}  // namespace karst::core::testing
