// Two builds of one policy, asked the same: answers and everything in them must be equal.
#pragma once
#include <gtest/gtest.h>

#include <deque>

#include "tests/abi/room.h"

namespace karst::test {

/// Asks both twenty times, with three windows and an event between any two requests. Returns how many goals
/// there were: a comparison of nothing proves nothing.
inline std::size_t expect_same_answers(core::PolicyPort& a, core::PolicyPort& b) {
  Room room;
  std::deque<core::FrontierCluster> windows(3, room.window);
  room.request.frontiers.clear();
  for (std::size_t k = 0; k < windows.size(); ++k) {
    windows[k].id = static_cast<std::uint32_t>(k + 7);
    windows[k].centroid += core::Vec3(0, 1.5 * static_cast<double>(k), -1.1 * static_cast<double>(k));
    room.request.frontiers.push_back({&windows[k], windows[k].centroid - core::Vec3(1.5, 0, 0), 0.1, 0.0});
  }
  std::size_t goals = 0;
  for (int i = 0; i < 20; ++i, ++room.request.sequence) {
    room.request.stamp += core::kSecond;
    room.request.state.position.x() = 1.5 + 0.3 * i;
    for (core::FrontierOffer& f : room.request.frontiers)
      f.path_length_m = (f.viewpoint - room.request.state.position).norm();
    const core::Decision da = a.decide(room.request), db = b.decide(room.request);
    EXPECT_EQ(da.outcome, db.outcome);
    EXPECT_EQ(da.reason, db.reason);
    EXPECT_EQ(da.log, db.log);
    EXPECT_EQ(da.drawings.size(), db.drawings.size());
    EXPECT_EQ(da.goals.size(), db.goals.size());
    for (std::size_t k = 0; k < std::min(da.goals.size(), db.goals.size()); ++k) {
      EXPECT_EQ(da.goals[k].position, db.goals[k].position);
      EXPECT_EQ(da.goals[k].score, db.goals[k].score);
      EXPECT_EQ(da.goals[k].frontier_id, db.goals[k].frontier_id);
      EXPECT_EQ(da.goals[k].why, db.goals[k].why);
    }
    goals += da.goals.size();
    if (da.goals.empty()) continue;
    const auto kind = i % 2 ? core::PolicyEvent::Kind::goal_reached : core::PolicyEvent::Kind::goal_rejected;
    for (core::PolicyPort* p : {&a, &b}) p->notify({kind, room.request.stamp, da.goals[0], "as it came"});
  }
  return goals;
}

}  // namespace karst::test
