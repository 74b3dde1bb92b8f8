#include "core_stack/mission/phases/steering.h"

#include "tests/unit/mission/drawn_map.h"
#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

CoreOptions flying(TrajectoryKind kind) {
  CoreOptions o;
  o.localization.source = PoseSource::pose_sensor;
  o.motion.trajectory = kind;
  return o;
}

class SteeringTest : public OnboardTest {
 protected:
  explicit SteeringTest(TrajectoryKind kind = TrajectoryKind::horizon)
      : OnboardTest(with_lidar(), flying(kind)) {}

  /// Flies ahead in a long hall for 3 m, to a goal that is farther away.
  void under_way(const Vec3& place) {
    onboard.map.while_idle().integrate(
        box_rays(VoxelMap{MapOptions{}}, Vec3(-3, -3, -1), Vec3(24, 3, 4), {"x+"}));
    hover();
    onboard.map.while_idle().set_home(onboard.flight.reference().position);
    phases.enter(Phase::takeoff, now());
    phases.enter(Phase::explore, now());
    accept(place);
    fly_ahead(3);
  }
  void accept(const Vec3& place) {
    Goal goal;
    goal.position = place;
    goal.heading_rad = std::numeric_limits<double>::quiet_NaN();
    goals.accept(goal, now());
  }
  void steps(double s) {
    for (double t = 0; t < s; t += 0.1) {
      steering.on_map(SeenWith::lidar);
      advance(0.1);
    }
  }
  Vec3 here() const { return onboard.flight.reference().position; }

  Steering steering{onboard, {phases, goals, path}};
};

struct SampledSteeringTest : SteeringTest {
  SampledSteeringTest() : SteeringTest(TrajectoryKind::sampled) {}
};

TEST_F(SteeringTest, GoesOnToTheGoalBeyondThePathUnderWay) {
  const Vec3 place(14, 1, 1.5);
  under_way(place);
  double nearest_m = 20;
  for (int i = 0; i < 14; ++i) {
    steps(1);
    nearest_m = std::min(nearest_m, (here() - place).norm());
  }
  EXPECT_LT(nearest_m, 0.6);
}

TEST_F(SampledSteeringTest, LeavesThePathUnderWayAlone) {
  under_way(Vec3(14, 1, 1.5));
  steps(8);
  EXPECT_NEAR(here().x(), 3, 0.05);
}

TEST_F(SteeringTest, DoesNotSetOutFromRest) {
  under_way(Vec3(14, 1, 1.5));
  advance(8);
  ASSERT_TRUE(onboard.flight.at_rest(now()));
  steps(2);
  EXPECT_NEAR(here().x(), 3, 0.05);
}

TEST_F(SteeringTest, LeavesAVehicleAloneThatBrakesMakesRoomOrGoesHome) {
  const Vec3 place(14, 1, 1.5);
  under_way(place);
  steps(1);
  path.yield(true);
  path.brake(now());
  steps(4);
  const Vec3 stood = here();
  EXPECT_LT(stood.x(), 6);
  steps(2);
  EXPECT_LT((here() - stood).norm(), 0.02);
}

TEST_F(SteeringTest, OnceHomeIsTheGoalNoPlanIsFlown) {
  under_way(Vec3(14, 1, 1.5));
  steps(1);
  const TimeNs end = onboard.flight.trajectory_end();
  phases.enter(Phase::home, now());
  steps(0.6);
  EXPECT_EQ(onboard.flight.trajectory_end(), end);
}

// With 0.08 s for localization, and 0.06 s for mapping, a scan that begins a plan changes the course 0.2 s
// after it.
TEST_F(SteeringTest, APlanIsFlownSixtyMillisecondsAfterTheMapHasChanged) {
  under_way(Vec3(14, 0, 1.5));
  advance(0.5);
  steering.on_map(SeenWith::lidar);
  const TimeNs end = onboard.flight.trajectory_end();
  advance(0.05);
  EXPECT_EQ(onboard.flight.trajectory_end(), end);
  advance(0.02);
  EXPECT_GT(onboard.flight.trajectory_end(), end);
}

TEST_F(SteeringTest, ImagesBeginPlansOnlyWhereScansStayAway) {
  under_way(Vec3(14, 0, 1.5));
  steering.on_map(SeenWith::lidar);
  advance(0.4);
  const TimeNs end = onboard.flight.trajectory_end();
  steering.on_map(SeenWith::camera);
  advance(0.15);
  EXPECT_EQ(onboard.flight.trajectory_end(), end) << "the next scan would wait for this plan";
  steering.on_map(SeenWith::camera);
  advance(0.1);
  EXPECT_GT(onboard.flight.trajectory_end(), end);
}

// A plan takes a moment; meanwhile the policy may have chosen another goal.
TEST_F(SteeringTest, APlanForAFormerGoalIsNotFlown) {
  under_way(Vec3(14, 0, 1.5));
  advance(0.5);
  steering.on_map(SeenWith::lidar);  // asks for a plan
  const TimeNs end = onboard.flight.trajectory_end();
  accept(Vec3(-1, 0, 1.5));
  advance(0.2);
  EXPECT_EQ(onboard.flight.trajectory_end(), end);
  steps(9);
  EXPECT_LT(here().x(), 0.5) << "but the next one is";
}

TEST_F(SteeringTest, APlanIsNotFlownFasterThanIsAllowedByThen) {
  under_way(Vec3(14, 0, 1.5));
  advance(0.5);
  steering.on_map(SeenWith::lidar);
  onboard.flight.cap_speed(now(), 0.5);
  advance(0.2);
  for (int i = 0; i < 40; ++i) {
    steps(0.1);
    if (i > 10) {
      EXPECT_LT(onboard.flight.reference().velocity_mps.norm(), 0.6) << i;
    }
  }
}

}  // namespace
}  // namespace karst::core
