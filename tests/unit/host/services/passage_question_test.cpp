#include "sdk/host/services/passage_question.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "sdk/host/services/session.h"
#include "tests/unit/host/services/drawn.h"

namespace karst::test {
namespace {

using testing::DrawnHost;
using testing::DrawnMap;

/// What a host says of the passages of a map.
struct Said {
  std::vector<karst_passage_t> passages;
  std::vector<karst_passage_end_t> ends;

  std::array<int, 5> kinds() const {
    std::array<int, 5> n{};
    for (const karst_passage_end_t& e : ends) ++n.at(e.kind);
    return n;
  }
  double length_m() const {
    double sum = 0;
    for (const karst_passage_t& p : passages) sum += p.length_m;
    return sum;
  }
  double volume_m3() const {
    double sum = 0;
    for (const karst_passage_t& p : passages) sum += p.volume_m3;
    for (const karst_passage_end_t& e : ends)
      if (e.kind == KARST_PASSAGE_JUNCTION) sum += e.volume_m3;
    return sum;
  }
};
Said said_by(const karst_host_t* h, const karst_map_t* map) {
  Said said;
  std::uint64_t passages = 0, ends = 0;
  karst_error_t e{};
  EXPECT_EQ(h->map->passages(h, map, nullptr, 0, &passages, nullptr, 0, &ends, &e), KARST_OK) << e.text;
  said.passages.resize(passages);
  said.ends.resize(ends);
  EXPECT_EQ(
      h->map->passages(h, map, said.passages.data(), passages, &passages, said.ends.data(), ends, &ends, &e),
      KARST_OK)
      << e.text;
  return said;
}

/// Three tubes that meet, open at their ends.
DrawnMap tee() {
  DrawnMap map(0.5, {});
  map.tube({0.25, 0.25, 0.25}, {30.25, 0.25, 0.25}, 1.5).tube({15.25, 0.25, 0.25}, {15.25, 20.25, 0.25}, 1.5);
  return map;
}
DrawnMap hall() {
  DrawnMap map(1.0, {});
  map.room({{10, 0, 0}, {22, 12, 5}});
  map.room({{0, 5, 0}, {10, 7, 2}}).room({{22, 5, 0}, {34, 7, 2}}).room({{15, 12, 0}, {17, 24, 2}});
  // Doors through the walls between them.
  return map.fill({{9.2, 5.2, 0.2}, {10.8, 6.8, 1.8}}, Cell::free)
      .fill({{21.2, 5.2, 0.2}, {22.8, 6.8, 1.8}}, Cell::free)
      .fill({{15.2, 11.2, 0.2}, {16.8, 12.8, 1.8}}, Cell::free);
}

/// A session that is deciding about a drawn map.
struct Asking {
  core::VoxelMap map;
  host::Session session{1, "test"};
  const karst_host_t* h = session.host();

  Asking(const DrawnMap& drawn, const Vec3& start) : map(to_core_map(drawn)) {
    session.set_decision_thread(std::this_thread::get_id());
    core::DecisionRequest request;
    request.map = &map;
    request.T_world_start.position = {start.x, start.y, start.z};
    session.begin_deciding(request);
  }
};

TEST(Passages, OfTheHostAndOfTheDrawnHostAreTheSame) {
  const struct {
    DrawnMap map;
    Vec3 start;
    int junctions;
  } cases[] = {{tee(), {1, 0.25, 0.25}, 1}, {tee(), {15.25, 19, 0.25}, 1}, {hall(), {1, 6, 1}, 1}};
  for (const auto& c : cases) {
    DrawnHost drawn(c.map);
    drawn.start = c.start;
    const Asking asking(c.map, c.start);
    const Said a = said_by(asking.h, asking.session.live_map()),
               b = said_by(drawn.host(), drawn.map_handle());
    EXPECT_EQ(a.kinds()[KARST_PASSAGE_JUNCTION], c.junctions);
    EXPECT_EQ(a.kinds(), b.kinds());
    EXPECT_EQ(a.passages.size(), b.passages.size());
    EXPECT_NEAR(a.length_m(), b.length_m(), 0.2 * b.length_m());
    EXPECT_NEAR(a.volume_m3(), b.volume_m3(), 0.05 * b.volume_m3());
    for (const Said* said : {&a, &b})
      for (const karst_passage_t& p : said->passages) {
        EXPECT_LE(p.ends[0], p.ends[1]);
        ASSERT_LT(p.ends[1], said->ends.size());
        EXPECT_LE(p.least_width_m, p.mean_width_m + 1e-9);
        EXPECT_GT(p.least_width_m, 1);
        EXPECT_LT(p.mean_width_m, 5);
      }
  }
}

TEST(Passages, AreWrittenAsManyAsThereIsRoomFor) {
  const Asking asking(tee(), {1, 0.25, 0.25});
  const karst_host_t* h = asking.h;
  std::vector<karst_passage_t> passages(2);
  std::vector<karst_passage_end_t> ends(2);
  passages[1].length_m = ends[1].width_m = -1;
  std::uint64_t passage_total = 0, end_total = 0;
  karst_error_t e{};
  ASSERT_EQ(h->map->passages(h, asking.session.live_map(), passages.data(), 1, &passage_total, ends.data(), 1,
                             &end_total, &e),
            KARST_OK);
  EXPECT_EQ(passage_total, 3u);
  EXPECT_EQ(end_total, 4u);
  EXPECT_GT(passages[0].length_m, 10);
  EXPECT_GT(ends[0].width_m, 0);
  EXPECT_EQ(passages[1].length_m, -1) << "beyond the capacity";
  EXPECT_EQ(ends[1].width_m, -1);
}

TEST(Passages, OfARetainedMapStayWhenTheMapOfTheRequestIsGone) {
  Asking asking(tee(), {1, 0.25, 0.25});
  const karst_host_t* h = asking.h;
  karst_error_t e{};
  const karst_map_t* kept = h->map->retain(h, asking.session.live_map(), &e);
  ASSERT_NE(kept, nullptr) << e.text;
  const Said live = said_by(h, asking.session.live_map());
  asking.session.end_deciding();
  asking.map = core::VoxelMap{core::MapOptions{}};
  const Said said = said_by(h, kept);
  ASSERT_EQ(said.passages.size(), live.passages.size());
  EXPECT_EQ(said.length_m(), live.length_m());
  const karst_vec3_t p{10, 0.25, 0.25};
  karst_passage_place_t place{};
  EXPECT_EQ(h->map->passages_at(h, kept, &p, 1, &place, &e), KARST_OK);
  EXPECT_EQ(place.passage, 0u);
  EXPECT_NEAR(place.width_m, 3.5, 0.1) << "seven cells of 0.5 m";
  h->map->release(h, kept);
  EXPECT_EQ(h->map->passages_at(h, kept, &p, 1, &place, &e), KARST_ERROR_STATE);
}

TEST(Passages, AreThoseOfTheNewMapInTheNextDecision) {
  Asking asking(tee(), {1, 0.25, 0.25});
  EXPECT_EQ(said_by(asking.h, asking.session.live_map()).passages.size(), 3u);
  asking.session.end_deciding();
  DrawnMap straight(0.5, {});
  straight.tube({0.25, 0.25, 0.25}, {30.25, 0.25, 0.25}, 1.5);
  const core::VoxelMap next = to_core_map(straight);
  core::DecisionRequest request;
  request.map = &next;
  request.T_world_start.position = {1, 0.25, 0.25};
  asking.session.begin_deciding(request);
  EXPECT_EQ(said_by(asking.h, asking.session.live_map()).passages.size(), 1u);
  request.T_world_start.position = {1, 100, 0.25};
  asking.session.begin_deciding(request);
  EXPECT_EQ(said_by(asking.h, asking.session.live_map()).passages.size(), 0u) << "far from the start";
}

TEST(PassageQuestion, IsAnsweredOnceForAllThreads) {
  const core::VoxelMap map = to_core_map(tee());
  host::PassageQuestion question;
  std::array<const core::PassageMap*, 4> answers{};
  std::vector<std::thread> threads;
  for (auto& answer : answers)
    threads.emplace_back([&] { answer = question.answer(map, core::Vec3(1, 0.25, 0.25)); });
  for (std::thread& t : threads) t.join();
  ASSERT_NE(answers[0], nullptr);
  EXPECT_EQ(answers[0]->passages.size(), 3u);
  for (const core::PassageMap* answer : answers) EXPECT_EQ(answer, answers[0]);
}

}  // namespace
}  // namespace karst::test
