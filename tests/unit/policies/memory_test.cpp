// What a policy remembers, out through the C table and back in.
#include <gtest/gtest.h>

#include <karst/ranking.h>
#include <karst/testing/bench.h>

namespace {

using karst::Memory;
using karst::testing::Bench;
using karst::testing::DrawnMap;

struct Visit {
  karst::Vec3 place;
  int times = 0;
};
struct Chapter {
  std::string title;
  std::vector<Visit> visits;
  void memory(Memory& m) { m.add(title), m.add(visits); }
};
struct All {
  bool flag = false;
  int number = 0;
  std::string text;
  std::vector<double> reals;
  std::vector<bool> bits;
  std::vector<std::string> texts;
  std::vector<Chapter> chapters;
  std::map<std::uint32_t, Visit> by_id;
  std::set<int> numbers;
  std::optional<std::string> perhaps, never;
  void memory(Memory& m) {
    m.add(flag), m.add(number), m.add(text), m.add(reals), m.add(bits), m.add(texts), m.add(chapters);
    m.add(by_id), m.add(numbers), m.add(perhaps), m.add(never);
  }
};

All something() {
  All a;
  a.flag = true, a.number = -7, a.text = "H\xc3\xb6hle";
  a.reals = {1.5, -0.0, 1e300}, a.bits = {true, false, true}, a.texts = {"", "b"};
  a.chapters = {{"one", {{{1, 2, 3}, 4}}}, {"two", {}}};
  a.by_id = {{3, {{0, 0, 1}, 2}}, {9, {}}}, a.numbers = {5, -5};
  a.perhaps = "yes";
  return a;
}
std::vector<unsigned char> bytes_of(All a) {
  Memory m;
  m.add(a);
  return m.sealed();
}

TEST(Memory, EveryKindOfFieldComesBack) {
  const std::vector<unsigned char> bytes = bytes_of(something());
  All back;
  back.texts = {"to be forgotten"}, back.never = "to be forgotten", back.numbers = {1};
  Memory m(bytes.data(), bytes.size());
  EXPECT_TRUE(m.reading());
  m.add(back);
  m.done();
  EXPECT_TRUE(back.flag);
  EXPECT_EQ(back.number, -7);
  EXPECT_EQ(back.text, "H\xc3\xb6hle");
  EXPECT_EQ(back.reals, something().reals);
  EXPECT_EQ(back.bits, something().bits);
  EXPECT_EQ(back.texts, something().texts);
  ASSERT_EQ(back.chapters.size(), 2u);
  ASSERT_EQ(back.chapters[0].visits.size(), 1u);
  EXPECT_EQ(back.chapters[0].visits[0].times, 4);
  EXPECT_EQ(back.chapters[1].title, "two");
  ASSERT_EQ(back.by_id.size(), 2u);
  EXPECT_EQ(back.by_id.at(3).place.z, 1.0);
  EXPECT_EQ(back.numbers, something().numbers);
  EXPECT_EQ(back.perhaps, something().perhaps);
  EXPECT_FALSE(back.never.has_value());
}

TEST(Memory, AnyBitThatChangedAndAnyByteThatIsMissingIsNoticed) {
  const std::vector<unsigned char> good = bytes_of(something());
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::vector<unsigned char> bad = good;
    bad[bit / 8] = static_cast<unsigned char>(bad[bit / 8] ^ (1u << (bit % 8)));
    EXPECT_THROW(Memory(bad.data(), bad.size()), karst::Error) << "bit " << bit;
  }
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(Memory(good.data(), size), karst::Error) << size << " bytes";
}

TEST(Memory, StateOfAnotherShapeIsRefusedBeforeItsLengthIsAllocated) {
  Memory m;
  std::uint64_t huge = std::uint64_t{1} << 60;
  m.add(huge);
  const std::vector<unsigned char> bytes = m.sealed();
  std::vector<double> reals;
  EXPECT_THROW(Memory(bytes.data(), bytes.size()).add(reals), karst::Error);
  std::map<int, std::string> map;
  EXPECT_THROW(Memory(bytes.data(), bytes.size()).add(map), karst::Error);
  Memory too_long(bytes.data(), bytes.size());
  EXPECT_THROW(too_long.done(), karst::Error);
}

/// Counts its decisions.
class Counting : public karst::Policy, public karst::Restorable {
  karst::Decision decide(const karst::Request&) override {
    return karst::Decision::hold("decision " + std::to_string(++count_));
  }
  void memory(Memory& m) override { m.add(count_); }
  int count_ = 0;
};
class Forgetful : public karst::Policy {
  karst::Decision decide(const karst::Request&) override { return karst::Decision::hold(""); }
};
const karst_plugin_t* plugin() {
  static const auto policy = [](std::uint32_t i) noexcept {
    return i == 0 ? karst::border::entry<Counting>("counting", "1.0.0", "Counts.")
                  : karst::border::entry<Forgetful>("forgetful", "1.0.0", "Forgets.");
  };
  static const karst_plugin_t p{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR, 2, policy};
  return &p;
}
DrawnMap nothing() { return {1.0, {}}; }

TEST(Restorable, GoesOnWhereItWasSaved) {
  Bench bench(plugin(), nothing());
  bench.decide(), bench.decide();
  const std::vector<unsigned char> bytes = bench.saved();
  EXPECT_EQ(bench.decide().reason, "decision 3") << "saving changes nothing";
  bench.restart(bytes);
  EXPECT_EQ(bench.decide().reason, "decision 3");
  bench.restart({});
  EXPECT_EQ(bench.decide().reason, "decision 1");
}

TEST(Restorable, DamageIsAnErrorWithItsReason) {
  Bench bench(plugin(), nothing());
  std::vector<unsigned char> bytes = bench.saved();
  bytes[0] ^= 1;
  try {
    bench.restart(bytes);
    FAIL() << "a damaged state was restored";
  } catch (const karst::Error& e) {
    EXPECT_STREQ(e.what(), "the saved state is cut short or damaged");
    EXPECT_EQ(e.code(), KARST_ERROR_ARGUMENT);
  }
}

TEST(Restorable, PolicyThatIsNotOneOffersNoTable) {
  Bench bench(plugin(), nothing(), {}, 1);
  EXPECT_THROW(bench.saved(), karst::Error);
}

// A place that failed stays closed for its pause, also after a restart.
TEST(Restorable, RankingKeepsItsPlaces) {
  karst::Ranking before, after;
  karst::Event failed;
  failed.kind = KARST_EVENT_GOAL_UNREACHABLE;
  failed.stamp_ns = 1'000'000'000;
  failed.goal.position = {5, 0, 0};
  before.on_event(failed);
  Memory out;
  before.memory(out);
  const std::vector<unsigned char> bytes = out.sealed();
  Memory in(bytes.data(), bytes.size());
  after.memory(in);
  in.done();
  const karst_map_t* no_map = nullptr;
  karst_frontier_cluster_t frontier{};
  frontier.id = 1, frontier.cells = 50;
  frontier.viewpoint.position = {5, 0, 0};
  frontier.path_length_m = 5;
  karst_request_t r{};
  r.map = no_map;
  r.frontiers = &frontier;
  r.frontier_count = 1;
  for (const std::int64_t stamp_ns : {2'000'000'000ll, 6'000'000'000ll}) {
    r.stamp_ns = stamp_ns;
    const karst::Request request(nullptr, r);
    const auto merit = [](const karst::Frontier&) { return karst::Merit{}; };
    const karst::Decision a = before.decide(request, merit), b = after.decide(request, merit);
    EXPECT_EQ(a.outcome, b.outcome);
    EXPECT_EQ(a.reason, b.reason);
    EXPECT_EQ(b.goals.size(), stamp_ns < 5'000'000'000 ? 0u : 1u);
  }
}

}  // namespace
