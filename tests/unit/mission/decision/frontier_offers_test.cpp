#include "core_stack/mission/decision/frontier_offers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/mission/mapped_world.h"

namespace karst::core {
namespace {

/// A vehicle at (3, 3, 2) in a room.
struct Offering {
  CoreOptions options = narrow_passages_allowed();
  VehicleDescription vehicle;
  WorldModel world;
  GoalLedger ledger;
  FrontierOffers offers;
  OfferQuery query;

  explicit Offering(const VoxelMap& map = room_open_to_x(), float half_fov_rad = 0.5f)
      : vehicle(lidar_vehicle_at_start(half_fov_rad)),
        world(options, vehicle),
        offers(options, vehicle, world, ledger) {
    world.integrate(rays_of(map));
    query.roadmap = &world.usual();
    query.from = Vec3(3, 3, 2);
    query.now = 100 * kSecond;
  }
  const std::map<std::uint32_t, FrontierCluster>& clusters() const { return world.frontiers().clusters(); }
  std::vector<std::uint32_t> find() {
    std::vector<std::uint32_t> ids;
    for (const FrontierOffer& o : offers.find(query).frontiers) ids.push_back(o.cluster->id);
    return ids;
  }
};

std::vector<std::uint32_t> without(std::vector<std::uint32_t> ids, std::uint32_t id) {
  std::erase(ids, id);
  return ids;
}

TEST(FrontierOffers, AreThoseWithAViewpointByIdAndWithTheLengthOfThePath) {
  Offering o;
  std::vector<std::uint32_t> oracle;
  for (const auto& [id, cluster] : o.clusters())
    if (open_cells(o.world.map(), cluster) >= o.options.mission.min_open_cells &&
        find_viewpoint(o.world.map(), cluster, o.vehicle, 0.6))
      oracle.push_back(id);
  ASSERT_GE(oracle.size(), 2u);
  EXPECT_EQ(o.find(), oracle);
  EXPECT_EQ(o.find(), oracle) << "from what is known by now";
  for (const FrontierOffer& offer : o.offers.find(o.query).frontiers) {
    EXPECT_FALSE(o.world.map().first_not_free(offer.viewpoint, offer.cluster->centroid));
    const double straight_m = (offer.viewpoint - o.query.from).norm();
    EXPECT_GE(offer.path_length_m, straight_m - 1e-9);
    EXPECT_LE(offer.path_length_m, 1.3 * straight_m);
  }
}

TEST(FrontierOffers, FollowTheMap) {
  Offering o;
  ASSERT_FALSE(o.find().empty());
  VoxelMap wall{MapOptions{}};  // the open side is shut
  const CellKey a = wall.key_of(Vec3(7.9, 0.1, 0.1)), b = wall.key_of(Vec3(7.9, 5.9, 3.9));
  for (int y = a.y; y <= b.y; ++y)
    for (int z = a.z; z <= b.z; ++z) wall.assign({a.x, y, z}, 1, 1.0f);
  for (int i = 0; i < 3; ++i) o.world.integrate(rays_of(wall));
  o.world.usual();
  EXPECT_TRUE(o.find().empty());
}

TEST(FrontierOffers, LeaveOutClosedPlacesAndTheFrontierThatIsFlownTo) {
  Offering o;
  const std::vector<std::uint32_t> all = o.find();
  ASSERT_GE(all.size(), 2u);
  o.query.leave_out = all[0];
  EXPECT_EQ(o.find(), without(all, all[0]));
  o.query.leave_out.reset();
  o.ledger.close(o.world.map(), o.clusters().at(all[1]).centroid, o.query.now, "seen");
  EXPECT_EQ(o.find(), without(all, all[1]));
  Offering p;
  const Vec3 viewpoint = p.offers.find(p.query).frontiers[0].viewpoint;
  p.ledger.close(p.world.map(), viewpoint, p.query.now, "no path");
  for (const FrontierOffer& offer : p.offers.find(p.query).frontiers)
    EXPECT_GE((offer.viewpoint - viewpoint).norm(), 0.8) << "closed within this distance";
}

TEST(FrontierOffers, OfOtherVehiclesClaimsAreMadeOnlyIfNothingElseIsLeft) {
  Offering o;
  const std::vector<std::uint32_t> all = o.find();
  ASSERT_GE(all.size(), 2u);
  o.query.claims = {{o.clusters().at(all[0]).centroid}, 0.1};
  EXPECT_EQ(o.find(), without(all, all[0]));
  o.query.claims.radius_m = 20;
  EXPECT_EQ(o.find(), all);
  EXPECT_EQ(o.offers.find(o.query).rules.at, o.query.now) << "which comes before waiving any pause";
}

TEST(FrontierOffers, InNarrowPassagesPausesAreWaivedIfNothingElseIsLeft) {
  Offering o;
  o.query.roadmap = o.world.narrow();
  const std::vector<std::uint32_t> all = o.find();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(o.offers.find(o.query).rules.at, o.query.now);
  const auto close_all = [&o] {
    for (const auto& [id, cluster] : o.clusters())
      o.ledger.close(o.world.map(), cluster.centroid, o.query.now, "seen");
  };
  for (int attempts = 1; attempts <= 5; ++attempts) {
    close_all();  // pauses of 10, 20, 40, 80 and 160 s
    const Offers open = o.offers.find(o.query);
    EXPECT_EQ(open.frontiers.size(), all.size()) << attempts;
    EXPECT_EQ(open.rules.at, o.query.now + 160 * kSecond);
    EXPECT_TRUE(open.rules.ignore_map_change);
  }
  close_all();
  EXPECT_TRUE(o.find().empty()) << "320 s";
  o.query.roadmap = &o.world.usual();
  o.query.now += 10000 * kSecond;
  EXPECT_TRUE(o.find().empty()) << "elsewhere the map must have changed as well";
}

/// A closed room from which a passage was seen through a tube of rock, 0.6 m wide and 4 m long: as a beam of
/// free cells beyond its end, too far for the viewpoints around a frontier. `crack`: with rock above and
/// below the beam.
VoxelMap room_with_a_tube(bool crack) {
  VoxelMap map{MapOptions{}};
  carve_box(map, Vec3(0, 0, 0), Vec3(8, 6, 4));
  const CellKey gap = map.key_of(Vec3(7.9, 3.1, 2.1));
  for (int x = 0; x < 36; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const bool inside = std::abs(y) < 2 && std::abs(z) < 2;
        if (inside || x < 20 || (crack && std::abs(z) == 2))
          map.assign(gap + CellKey{x, y, z}, 1, inside ? -1.0f : 1.0f);
      }
  return map;
}

/// Looks at all that is offered until nothing is: the greatest x at which a frontier was offered.
double look_at_all(Offering& o) {
  double furthest_m = 0;
  for (int round = 0; round < 20; ++round) {
    const Offers found = o.offers.find(o.query);
    if (!any_reachable(found.frontiers)) return furthest_m;
    for (const FrontierOffer& offer : found.frontiers) {
      EXPECT_LT(offer.viewpoint.x(), 8) << "in the room";
      furthest_m = std::max(furthest_m, offer.cluster->centroid.x());
      o.ledger.close(o.world.map(), offer.viewpoint, o.query.now, "seen");
    }
  }
  ADD_FAILURE() << "it never ends";
  return furthest_m;
}

TEST(FrontierOffers, APassageSeenThroughAGapIsLookedAtFromTheNearestPlaceThatCanBeReached) {
  Offering o(room_with_a_tube(false));
  EXPECT_GT(look_at_all(o), 12);
}

TEST(FrontierOffers, ACrackIsNotLookedAtFromADistance) {
  Offering o(room_with_a_tube(true));
  EXPECT_FALSE(o.clusters().empty());
  EXPECT_EQ(look_at_all(o), 0);
}

TEST(FrontierOffers, AFrontierThatNoSensorLooksIntoIsExplainedOnce) {
  // A flat LiDAR below the open top of a chimney.
  VoxelMap chimney{MapOptions{}};
  carve_box(chimney, Vec3(0, 0, 0), Vec3(6, 6, 8), {"z+"});
  Offering o(chimney, 0.05f);
  EXPECT_TRUE(o.find().empty());
  const std::vector<UnseenFrontier> unseen = o.offers.take_unseen();
  ASSERT_FALSE(unseen.empty());
  std::set<std::uint32_t> ids;
  for (const UnseenFrontier& u : unseen) {
    EXPECT_TRUE(ids.insert(u.id).second) << "though it was looked for twice";
    EXPECT_EQ(u.position, o.clusters().at(u.id).centroid);
    EXPECT_NE(u.reason.find("above it there"), std::string::npos) << u.reason;
  }
  VoxelMap more{MapOptions{}};  // the map changes there: the viewpoints are looked for anew
  carve_box(more, Vec3(2, 2, 7), Vec3(3, 3, 7.4));
  o.world.integrate(rays_of(more));
  o.world.usual();
  o.find();
  for (const UnseenFrontier& u : o.offers.take_unseen()) EXPECT_FALSE(ids.contains(u.id));

  Offering seeing(chimney, 1.5f);
  EXPECT_FALSE(seeing.find().empty());
  EXPECT_TRUE(seeing.offers.take_unseen().empty());
}

}  // namespace
}  // namespace karst::core
