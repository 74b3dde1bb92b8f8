#include "core_stack/mission/recording/run_event.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace karst::core::event {
namespace {

void draw(bool& v) { v = *rc::gen::arbitrary<bool>(); }
void draw(double& v) { v = *rc::gen::inRange(0, 8) == 0 ? kUnknown : *rc::gen::arbitrary<double>(); }
template <std::integral Integer>
void draw(Integer& v) {
  v = *rc::gen::arbitrary<Integer>();
}
void draw(std::string& v) { v = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)); }
void draw(Vec3& p) {
  for (double& v : p.reshaped()) draw(v);
}
void draw(Cluster& c) {
  draw(c.id);
  draw(c.centroid);
  draw(c.unknown_cells);
}
template <NamedEnum E>
void draw(E& v) {
  constexpr auto names = names_of(E{});
  v = names[*rc::gen::inRange<std::size_t>(0, names.size())].value;
}
template <class T>
void draw(std::vector<T>& all) {
  all.resize(*rc::gen::inRange<std::size_t>(0, 5));
  for (T& one : all) draw(one);
}
template <class T>
void draw(std::optional<T>& v) {
  v.reset();
  if (*rc::gen::arbitrary<bool>()) draw(v.emplace());
}

template <class T>
bool same(const T& a, const T& b) {
  return a == b;
}
bool same(const double& a, const double& b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool same(const Vec3& a, const Vec3& b) {
  return same(a.x(), b.x()) && same(a.y(), b.y()) && same(a.z(), b.z());
}
bool same(const Cluster& a, const Cluster& b) {
  return a.id == b.id && same(a.centroid, b.centroid) && a.unknown_cells == b.unknown_cells;
}
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return same(x, y); });
}
template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

template <class E>
class EveryKind : public ::testing::Test {};

template <class Variant>
struct TypesOf;
template <class... Kinds>
struct TypesOf<std::variant<Kinds...>> {
  using Types = ::testing::Types<Kinds...>;
};
TYPED_TEST_SUITE(EveryKind, TypesOf<Event>::Types);

TYPED_TEST(EveryKind, IsReadAsItWasWritten) {
  using E = TypeParam;
  EXPECT_TRUE(rc::check([] {
    E e;
    std::apply([&e](const auto&... f) { (draw(e.*f.member), ...); }, E::fields());
    const TimeNs t = *rc::gen::inRange<TimeNs>(0, 86400 * kSecond);
    const std::string line = line_of(t, e);
    const nlohmann::json parsed = nlohmann::json::parse(line);
    RC_ASSERT(from_seconds(parsed.at("t")) == t);
    const std::optional<E> back = as<E>(parsed);
    RC_ASSERT(back.has_value());
    std::apply([&](const auto&... f) { (RC_ASSERT(same(e.*f.member, (*back).*f.member)), ...); },
               E::fields());
    RC_ASSERT(line_of(t, *back) == line);
  }));
}

std::string error_of(const char* line) {
  try {
    read(nlohmann::json::parse(line));
  } catch (const Malformed& e) {
    return e.what();
  }
  return "none";
}

TEST(RunEvent, StandsInTheFileAfterTimeAndKindByTheNamesOfItsFields) {
  EXPECT_EQ(line_of(1500 * kMillisecond, Landing{.state = LandingState::given_up, .reason = "no \"way\""}),
            R"({"t":1.5,"kind":"landing","reason":"no \"way\"","state":"given up"})");
  EXPECT_EQ(line_of(0, Goal{.state = GoalState::accepted,
                            .position = {1, 2, 3},
                            .score = 0.5,
                            .why = "near",
                            .reason = ""}),
            R"({"t":0.0,"kind":"goal","frontier":0,"heading":null,"position":[1.0,2.0,3.0],"reason":"",)"
            R"("score":0.5,"state":"accepted","why":"near"})");
}

TEST(RunEvent, TextsThatAreNoUtf8DoNotKeepItFromBeingWritten) {
  const auto line = nlohmann::json::parse(line_of(2 * kSecond, Log{"bad \xff utf-8"}));
  EXPECT_EQ(as<Log>(line)->text, "bad \xef\xbf\xbd utf-8");
}

TEST(RunEvent, FieldsMadeIntoTextBeforeMakeTheSameLine) {
  const Event drawing = Drawing{core::Drawing::Kind::lines, {{1.5, 2, 3}}, 0xff00ff, "a \"b\""};
  EXPECT_EQ(line_of(kSecond, Drawing::kKind, fields_text(drawing)), line_of(kSecond, drawing));
}

TEST(RunEvent, AMalformedLineIsAnErrorThatNamesKindAndField) {
  EXPECT_EQ(
      error_of(R"({"kind": "phase", "phase": "dive"})"),
      "phase: phase: expected one of standby, takeoff, look, explore, home, land, manual, done, replay");
  EXPECT_EQ(error_of(R"({"kind": "phase", "reason": ""})"), "phase: phase: expected that it is there");
  EXPECT_EQ(error_of(R"({"kind": "goal", "state": "accepted", "position": [1, 2]})"),
            "goal: position: expected a point [x, y, z]");
  EXPECT_EQ(error_of(R"({"kind": "goal", "state": "accepted", "score": "good"})"),
            "goal: score: expected a number or null");
  EXPECT_EQ(error_of(R"({"kind": "object", "state": "found", "number": -1})"),
            "object: number: expected a whole number that fits");
  EXPECT_EQ(error_of(R"({"kind": "frontiers", "clusters": [[1, 2, 3]]})"),
            "frontiers: clusters: expected clusters [id, x, y, z, cells]");
}

TEST(RunEvent, LinesOfOtherVersionsAreRead) {
  EXPECT_FALSE(read(nlohmann::json::parse(R"({"t": 1, "kind": "applause"})")));
  const auto end =
      as<Outcome>(nlohmann::json::parse(R"({"kind": "outcome", "outcome": "landed", "mood": "good"})"));
  ASSERT_TRUE(end);
  EXPECT_EQ(end->outcome, MissionOutcome::landed);
  EXPECT_FALSE(end->mass_kg);
  EXPECT_FALSE(as<Phase>(nlohmann::json::parse(R"({"kind": "log"})")));
}

}  // namespace
}  // namespace karst::core::event
