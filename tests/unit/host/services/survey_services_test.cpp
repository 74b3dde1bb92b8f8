// The extension "karst.survey/1", asked as a policy in C++ asks it.
#include <gtest/gtest.h>

#include <karst/survey.h>
#include <karst/testing/drawn_survey.h>

#include <cmath>
#include <random>
#include <string>
#include <thread>

#include "sdk/host/services/session.h"
#include "sdk/host/services/translation.h"

namespace karst::host {
namespace {

/// A passage to the east that goes down, and a branch to the north; the survey ends at both.
struct Surveyed : ::testing::Test {
  core::VoxelMap map{core::MapOptions{}};
  core::SurveyedPassages survey{
      {{{0, 0, 0}, {10, 0, 0}, {20, 2, -9}, {10, 8, 1}},
       {{0, 1, {1, 2, 3, 0.5}, {2, 2, 1, 1}}, {1, 2, {2, 2, 1, 1}, {3, 1, 2, 2}}, {1, 3, {}, {1, 1, 1, 1}}},
       {{2, false}, {3, true}}}};
  core::DecisionRequest request;
  Session session{1, "test"};
  const karst_host_t* h = session.host();

  void SetUp() override {
    request.map = &map;
    request.survey = &survey;
    session.set_decision_thread(std::this_thread::get_id());
  }
  const karst_survey_service_t* service() const {
    const std::string id = KARST_SURVEY_ID;
    return static_cast<const karst_survey_service_t*>(h->extension(h, karst::to_abi(id)));
  }
};

TEST_F(Surveyed, LegsAndLeadsAreThoseOfTheMission) {
  session.begin_deciding(request);
  const auto view = karst::SurveyView::of(h);
  ASSERT_TRUE(view);
  const std::vector<karst::SurveyLeg> legs = view->legs();
  ASSERT_EQ(legs.size(), 3u);
  EXPECT_EQ(legs[1].from_station, 1u);
  EXPECT_EQ(legs[1].to_station, 2u);
  EXPECT_EQ(to_core(legs[1].from), core::Vec3(10, 0, 0));
  EXPECT_EQ(to_core(legs[1].to), core::Vec3(20, 2, -9));
  EXPECT_EQ(legs[1].to_size.left_m, 3);
  EXPECT_EQ(legs[1].to_size.right_m, 1);
  EXPECT_EQ(legs[0].from_size.up_m, 3);
  EXPECT_EQ(legs[0].from_size.down_m, 0.5);
  EXPECT_EQ(legs[2].from_size.up_m, KARST_SURVEY_DEFAULT_WALL_M);
  const std::vector<karst::SurveyLead> leads = view->leads();
  ASSERT_EQ(leads.size(), 2u);
  EXPECT_EQ(leads[0].station, 2u);
  EXPECT_EQ(leads[0].kind, karst_survey_lead_kind_t{KARST_LEAD_END});
  EXPECT_EQ(to_core(leads[1].position), core::Vec3(10, 8, 1));
  EXPECT_EQ(leads[1].kind, karst_survey_lead_kind_t{KARST_LEAD_CONTINUATION});
}

TEST_F(Surveyed, DistancesAreTheCoresAndThoseOfTheTestKit) {
  session.begin_deciding(request);
  const auto view = karst::SurveyView::of(h);
  ASSERT_TRUE(view);
  karst::testing::DrawnSurvey drawn;
  drawn.legs = view->legs();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-15, 30);
  std::vector<karst::Vec3> points(KARST_MAX_BATCH + 1);
  for (karst::Vec3& p : points) p = {at(random), at(random), at(random)};
  const std::vector<double> distances = view->distances(points);
  ASSERT_EQ(distances.size(), points.size());
  for (std::size_t i = 0; i < 2000; ++i) {
    EXPECT_EQ(distances[i], survey.distance_m(to_core(points[i])));
    EXPECT_NEAR(distances[i], drawn.distance_m(points[i]), 1e-9);
  }
  EXPECT_EQ(distances.back(), survey.distance_m(to_core(points.back())));
}

TEST_F(Surveyed, NoMoreIsWrittenThanThereIsRoomFor) {
  session.begin_deciding(request);
  karst_survey_leg_t legs[2] = {};
  std::uint64_t total = 0;
  karst_error_t e{};
  EXPECT_EQ(service()->legs(h, legs, 1, &total, &e), KARST_OK);
  EXPECT_EQ(total, 3u);
  EXPECT_EQ(legs[0].to.x, 10);
  EXPECT_EQ(legs[1].to.x, 0);
}

TEST_F(Surveyed, WithoutASurveyTheViewIsEmptyAndNobodyFails) {
  request.survey = nullptr;
  session.begin_deciding(request);
  EXPECT_FALSE(karst::SurveyView::of(h));
  karst_error_t e{};
  std::uint64_t total = 0;
  EXPECT_EQ(service()->leads(h, nullptr, 0, &total, &e), KARST_ERROR_UNAVAILABLE);
  const karst_vec3_t p{0, 0, 0};
  double d = 0;
  EXPECT_EQ(service()->distances(h, &p, 1, &d, &e), KARST_ERROR_UNAVAILABLE);
}

TEST_F(Surveyed, OutsideOfADecisionOrOnAnotherThreadNothingIsSaid) {
  std::uint64_t total = 0;
  karst_error_t e{};
  EXPECT_EQ(service()->legs(h, nullptr, 0, &total, &e), KARST_ERROR_STATE);
  session.begin_deciding(request);
  EXPECT_EQ(service()->legs(h, nullptr, 0, &total, &e), KARST_OK);
  std::thread([&] { EXPECT_EQ(service()->legs(h, nullptr, 0, &total, &e), KARST_ERROR_THREAD); }).join();
  session.end_deciding();
  EXPECT_EQ(service()->legs(h, nullptr, 0, &total, &e), KARST_ERROR_STATE);
}

TEST_F(Surveyed, BadArgumentsAreRefused) {
  session.begin_deciding(request);
  karst_error_t e{};
  std::uint64_t total = 0;
  EXPECT_EQ(service()->legs(h, nullptr, 0, nullptr, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(service()->leads(h, nullptr, 1, &total, &e), KARST_ERROR_ARGUMENT);
  const karst_vec3_t nowhere{NAN, 0, 0};
  double d = 0;
  EXPECT_EQ(service()->distances(h, &nowhere, 1, &d, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(service()->distances(h, nullptr, 1, &d, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(service()->distances(h, &nowhere, KARST_MAX_BATCH + 1, &d, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->extension(h, {"karst.survey/2", 14}), nullptr);
}

}  // namespace
}  // namespace karst::host
