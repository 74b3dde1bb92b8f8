#include "core_stack/team/team_objects.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "core_stack/common/random.h"
#include "core_stack/team/team_node.h"

namespace karst::core {
namespace {

ObjectSeen report(double t_s, std::uint32_t number, std::uint8_t kind, const Vec3& p, double deviation_m) {
  return {from_seconds(t_s), number, kind, p, deviation_m};
}

TEST(TeamObjects, OfTwoFindersAreOneInTheirWeightedMean) {
  ReportedObjects reports;
  note(reports, 1, report(5, 1, 3, {10, 0, 0}, 0.2));
  note(reports, 2, report(9, 4, 3, {10.5, 0, 0}, 0.1));
  const auto all = merged(reports);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].position.x(), (10 / 0.04 + 10.5 / 0.01) / (1 / 0.04 + 1 / 0.01), 1e-12);
  EXPECT_NEAR(all[0].deviation_m, 1 / std::sqrt(1 / 0.04 + 1 / 0.01), 1e-12);
  const std::vector<std::pair<RobotId, std::uint32_t>> by{{1, 1}, {2, 4}};
  EXPECT_EQ(all[0].reported_by, by);
}

TEST(TeamObjects, StayApartIfFarOrOfAnotherKindOrOfOneFinder) {
  ReportedObjects reports;
  note(reports, 1, report(1, 1, 3, {0, 0, 0}, 0.1));
  note(reports, 2, report(1, 1, 3, {2, 0, 0}, 0.1));  // farther than 1 m and what both may be off by
  note(reports, 2, report(1, 2, 4, {0, 0, 0}, 0.1));
  note(reports, 1, report(1, 2, 3, {0.5, 0, 0}, 0.1));
  EXPECT_EQ(merged(reports).size(), 4u);
}

TEST(TeamObjects, TakenBackAreGoneForGood) {
  ReportedObjects reports;
  note(reports, 1, report(7, 1, 0, {0, 0, 0}, 0.1));
  note(reports, 1, report(3, 1, 5, {0, 0, 0}, 0.1));  // late on the air
  EXPECT_TRUE(merged(reports).empty());
}

RC_GTEST_PROP(TeamObjects, AreTheSameInWhateverOrderReportsCome, (std::uint64_t seed)) {
  Random random(seed);
  std::vector<std::pair<RobotId, ObjectSeen>> reports;
  for (RobotId r = 1; r <= 3; ++r)
    for (std::uint32_t n = 1; n <= 4; ++n)
      for (int revision = 0; revision < 3; ++revision)
        reports.push_back(
            {r, report(10 * revision + n, n, static_cast<std::uint8_t>(random.uniform() * 3),
                       {random.uniform(0, 6), random.uniform(0, 2), 0}, random.uniform(0.1, 0.5))});
  ReportedObjects in_order, shuffled;
  for (const auto& [robot, seen] : reports) note(in_order, robot, seen);
  for (std::size_t i = reports.size() - 1; i > 0; --i)
    std::swap(reports[i], reports[static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1))]);
  for (const auto& [robot, seen] : reports) note(shuffled, robot, seen);
  const auto a = merged(in_order), b = merged(shuffled);
  RC_ASSERT(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    RC_ASSERT(a[i].position == b[i].position);
    RC_ASSERT(a[i].reported_by == b[i].reported_by);
    for (const auto& key : a[i].reported_by) RC_ASSERT(in_order.at(key).kind == a[i].kind);
  }
}

TEST(TeamObjects, ComeToTheBaseOverTheAir) {
  const Vec3 base(0, 0, 1);
  const MissionKey radio_key = key_of_seed(1);
  TeamNode finder(1, {}, {}, base, 1, radio_key), at_base(kBase, {}, {}, base, 1, radio_key);
  EXPECT_GT(finder.publish(report(1, 7, 2, {12.34, -5.6, 0.7}, 0.3)), 0u);
  for (int i = 1; i <= 100; ++i) {
    const TimeNs now = i * 100 * kMillisecond;
    const auto from_finder = finder.transmit(now), from_base = at_base.transmit(now);
    for (const Bytes& b : from_finder) at_base.receive(b, now);
    for (const Bytes& b : from_base) finder.receive(b, now);
  }
  ASSERT_EQ(at_base.objects().size(), 1u);
  const auto& [key, seen] = *at_base.objects().begin();
  EXPECT_EQ(key, (std::pair<RobotId, std::uint32_t>{1, 7}));
  EXPECT_LT((seen.position - Vec3(12.34, -5.6, 0.7)).norm(), 1e-9);
  EXPECT_EQ(finder.gossip().known_at_base(), 1u) << "and the finder learns that it did";
}

}  // namespace
}  // namespace karst::core
