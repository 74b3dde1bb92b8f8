// Regions against brute force: depths by samples of the surface, crossings by another rule.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <boost/property_tree/ptree.hpp>
#include <numbers>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/mapping/region/region_keys.h"

namespace karst::core {
namespace {

/// A star-shaped outline, so that it surely does not cross itself, in either sense.
Outline random_outline(Random& random) {
  const int corners = 3 + static_cast<int>(random.uniform(0, 9));
  const Eigen::Vector2d middle(random.uniform(-20, 20), random.uniform(-20, 20));
  Outline out;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform(0.1, 0.9)) / corners;
    out.push_back(middle + random.uniform(2, 9) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  if (random.uniform() < 0.5) std::reverse(out.begin(), out.end());
  return out;
}

Prism random_prism(Random& random) {
  const double low = random.uniform(-5, 3);
  return {random_outline(random), low, low + random.uniform(0.5, 8)};
}

/// By the winding number, where depth_in counts crossings.
bool is_inside(const Prism& prism, const Vec3& p) {
  double turned = 0;
  for (std::size_t i = 0; i < prism.outline.size(); ++i) {
    const Eigen::Vector2d a = prism.outline[i] - p.head<2>(),
                          b = prism.outline[(i + 1) % prism.outline.size()] - p.head<2>();
    turned += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return std::abs(turned) > std::numbers::pi && p.z() > prism.low_m && p.z() < prism.high_m;
}

/// To points of the walls, and to the nearest points of floor and roof that lie in the outline.
double sampled_distance(const Prism& prism, const Vec3& p, double step_m) {
  double least = 1e9;
  for (std::size_t i = 0; i < prism.outline.size(); ++i) {
    const Eigen::Vector2d a = prism.outline[i], b = prism.outline[(i + 1) % prism.outline.size()];
    const int n = static_cast<int>((b - a).norm() / step_m) + 1;
    for (int k = 0; k <= n; ++k) {
      const Eigen::Vector2d q = a + (b - a) * k / n;
      least = std::min(least, (Vec3(q.x(), q.y(), std::clamp(p.z(), prism.low_m, prism.high_m)) - p).norm());
    }
  }
  const Vec3 level(p.x(), p.y(), (prism.low_m + prism.high_m) / 2);
  if (is_inside(prism, level))
    least = std::min({least, std::abs(p.z() - prism.low_m), std::abs(p.z() - prism.high_m)});
  return least;
}

TEST(Prism, DepthIsTheDistanceFromItsSurfaceWithTheSignOfTheSide) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const Prism prism = random_prism(random);
    RC_ASSERT(!flaw_of(prism));
    for (int i = 0; i < 40; ++i) {
      const Vec3 p(prism.outline[0].x() + random.uniform(-12, 12),
                   prism.outline[0].y() + random.uniform(-12, 12), random.uniform(-8, 14));
      const double depth = depth_in(prism, p), sampled = sampled_distance(prism, p, 0.02);
      RC_ASSERT(std::abs(std::abs(depth) - sampled) < 0.02);
      if (sampled > 1e-6) RC_ASSERT((depth > 0) == is_inside(prism, p));
    }
  }));
}

TEST(Prism, ABoxIsThePrismOfItsCorners) {
  const Prism prism = box({4, -1, 3}, {-2, 5, -7});
  EXPECT_EQ(flaw_of(prism), std::nullopt);
  EXPECT_DOUBLE_EQ(depth_in(prism, {1, 2, -2}), 3);
  EXPECT_DOUBLE_EQ(depth_in(prism, {1, 2, 2.5}), 0.5);
  EXPECT_DOUBLE_EQ(depth_in(prism, {7, 9, 0}), -5);
  EXPECT_DOUBLE_EQ(depth_in(prism, {1, 2, 5}), -2);
}

/// Whether edges cross, by solving for where they do.
bool crosses_itself(const Outline& o) {
  const std::size_t n = o.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const Eigen::Vector2d a = o[i], u = o[i + 1] - a, b = o[j], v = o[(j + 1) % n] - b;
      const double across = u.x() * v.y() - u.y() * v.x();
      if (std::abs(across) < 1e-12) continue;
      const Eigen::Vector2d w = b - a;
      const double s = (w.x() * v.y() - w.y() * v.x()) / across, t = (w.x() * u.y() - w.y() * u.x()) / across;
      if (s > 0 && s < 1 && t > 0 && t < 1) return true;
    }
  return false;
}

TEST(Prism, APolygonThatCrossesItselfIsFoundOut) {
  int crossing = 0, simple = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    Random random(seed);
    Outline outline;
    const int corners = 4 + static_cast<int>(random.uniform(0, 3));
    for (int i = 0; i < corners; ++i) outline.emplace_back(random.uniform(-9, 9), random.uniform(-9, 9));
    const bool expected = crosses_itself(outline);
    RC_ASSERT(flaw_of({outline, 0, 1}).has_value() == expected);
    ++(expected ? crossing : simple);
  }));
  EXPECT_GT(crossing, 10);
  EXPECT_GT(simple, 10);
}

TEST(Prism, WhatIsNoPolygonIsFoundOut) {
  const auto flaw = [](const Outline& outline, double low = 0, double high = 1) {
    return flaw_of({outline, low, high}).value_or("");
  };
  EXPECT_NE(flaw({}).find("three corners"), std::string::npos);
  EXPECT_NE(flaw({{0, 0}, {1, 0}}).find("three corners"), std::string::npos);
  EXPECT_NE(flaw({{0, 0}, {0, 0}, {1, 0}, {1, 1}}).find("two corners"), std::string::npos);
  EXPECT_NE(flaw({{0, 0}, {1, 0}, {2, 0}}).find("meets"), std::string::npos);                  // runs back
  EXPECT_NE(flaw({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}).find("meets"), std::string::npos);  // touches
  EXPECT_NE(flaw({{0, 0}, {1, 0}, {1, 1}}, 2, 2).find("not below"), std::string::npos);
  EXPECT_NE(flaw({{0, 0}, {1, 0}, {1, 1}}, 2, 1).find("not below"), std::string::npos);
  EXPECT_EQ(flaw({{0, 0}, {1, 0}, {2, 0}, {2, 1}}), "");  // three corners in a line are none
}

TEST(FlightRegion, DepthIsTheDistanceToWhatLiesOutside) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    FlightRegion::Limits limits;
    limits.margin_m = 0.5;
    limits.keep_in = box({-15, -15, -4}, {15, 15, 6});
    for (int i = 0; i < 3; ++i) limits.keep_out.push_back(random_prism(random));
    const FlightRegion region(limits);
    const auto allowed = [&](const Vec3& p) {
      return depth_in(*limits.keep_in, p) >= 0 &&
             std::none_of(limits.keep_out.begin(), limits.keep_out.end(),
                          [&](const Prism& out) { return depth_in(out, p) > 0; });
    };
    for (int i = 0; i < 20; ++i) {
      const Vec3 p(random.uniform(-16, 16), random.uniform(-16, 16), random.uniform(-5, 7));
      const double depth = region.depth_m(p);
      if (std::abs(depth) > 1e-9) RC_ASSERT(region.contains(p) == allowed(p));
      RC_ASSERT(region.may_fly(p) == (depth >= 0.5));
      for (int k = 0; k < 30; ++k) {  // nothing nearer than the depth lies outside, and it changes no faster
        const Vec3 away = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        const double far = random.uniform(0, 4);
        const Vec3 q = p + far * away;
        if (depth > 0 && far < depth) RC_ASSERT(allowed(q));
        RC_ASSERT(std::abs(region.depth_m(q) - depth) <= far + 1e-9);
      }
      RC_ASSERT(allowed(p) || region.nearest_part(p) != "region");
    }
  }));
}

std::string refusal(const RegionKeys& keys) {
  try {
    region_of("cave.mission", keys);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

RegionKeys keep_in(const std::string& text) {
  RegionKeys keys;
  keys.keep_in = text;
  return keys;
}
RegionKeys keep_out(const std::string& text) {
  RegionKeys keys;
  keys.keep_out = text;
  return keys;
}

TEST(RegionKeys, AreReadAsWritten) {
  RegionKeys keys = keep_in("polygon 0 0  10 0  10 5.5  0 5.5 from -2 to 7");
  keys.keep_out = " box 1 1 0  2 2 1 |polygon 4 1 5 1 5 2";
  keys.max_home_m = 30;
  const auto region = region_of("", keys);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->limits().keep_in->outline.size(), 4u);
  EXPECT_EQ(region->limits().keep_in->low_m, -2);
  EXPECT_EQ(region->limits().keep_in->high_m, 7);
  ASSERT_EQ(region->limits().keep_out.size(), 2u);
  EXPECT_EQ(region->limits().keep_out[1].high_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(region->limits().max_home_m, 30);
  EXPECT_DOUBLE_EQ(region->depth_m({3, 2, 0}), 1);  // to the second keep-out or the box
  EXPECT_EQ(region->nearest_part({1.5, 1.5, 0.5}), "number 1 of region.keep_out");
  EXPECT_EQ(region->nearest_part({-1, 1.5, 0.5}), "region.keep_in");
}

TEST(RegionKeys, NumbersMayHaveAPlusSign) {
  const auto region = region_of("", keep_in("polygon 0 0  +10 0  1e+1 +5.5  0 5.5 from -2 to +7"));
  ASSERT_TRUE(region);
  EXPECT_EQ(region->limits().keep_in->outline.at(1).x(), 10);
  EXPECT_EQ(region->limits().keep_in->outline.at(2), (Eigen::Vector2d(10, 5.5)));
  EXPECT_EQ(region->limits().keep_in->high_m, 7);
  for (const char* none : {"+", "+-1", "++1", "+ 1"})
    EXPECT_FALSE(refusal(keep_in(std::string("box 0 0 0 1 1 ") + none)).empty()) << none;
}

TEST(RegionKeys, APolygonMayRepeatItsFirstCorner) {
  RegionKeys open, closed;
  open.keep_in = "polygon -10 -10 10 -10 10 10 -10 10 from -5 to 5";
  closed.keep_in = "polygon -10 -10 10 -10 10 10 -10 10 -10 -10 from -5 to 5";
  EXPECT_EQ(region_of("m", closed)->limits().keep_in->outline,
            region_of("m", open)->limits().keep_in->outline);
  closed.keep_in = "polygon 0 0 5 0 0 0";
  EXPECT_THROW(region_of("m", closed), InputError);
}

TEST(RegionKeys, WithoutLimitsThereIsNoRegion) {
  EXPECT_FALSE(region_of("", RegionKeys{}));
  EXPECT_FALSE(region_in("", boost::property_tree::ptree()));
}

TEST(RegionKeys, BadOnesAreRefusedWithFileKeyAndReason) {
  for (const auto& [keys, part] : std::vector<std::pair<RegionKeys, std::string>>{
           {keep_in("ball 0 0 0 3"), "expected \"box"},
           {keep_in("box 0 0 0 1 1"), "a number is missing"},
           {keep_in("box 0 0 0 1 1 1 1"), "one word too many"},
           {keep_in("box 0 0 0 1 1 0"), "not below"},
           {keep_in("box 0 0 0 1 0 1"), "two corners"},
           {keep_in("box 0 0 0 1 1 nan"), "no number"},
           {keep_in("box 0 0 0 1 1 1e9"), "no number"},
           {keep_in("box 0 0 0 1 1 2x"), "no number"},
           {keep_in("polygon 0 0 1 1"), "three corners"},
           {keep_in("polygon 0 0 1 1 0 1 1"), "a number is missing"},
           {keep_in("polygon 0 0 1 1 1 0 0 1"), "meets"},
           {keep_in("polygon 0 0 1 0 1 1 from 2 to 1"), "not below"},
           {keep_in("polygon 0 0 1 0 1 1 to 2 from 1"), "one word too many"},
           {keep_in("polygon 0 0 1 0 1 1 from"), "a number is missing"},
           {keep_in(" "), "expected"},
           {keep_out("box 0 0 0 1 1 1 |"), "expected"},
           {keep_out("| box 0 0 0 1 1 1"), "expected"},
           {keep_out("box 0 0 0 1 1 1 | box 0 0 0 1 1"), "a number is missing"}}) {
    const std::string what = refusal(keys);
    EXPECT_TRUE(what.starts_with("cave.mission: region.keep_")) << what;
    EXPECT_NE(what.find(part), std::string::npos) << what;
  }
  std::string many = "polygon";
  for (int i = 0; i < 300; ++i) many += " " + std::to_string(i) + " " + std::to_string(i * i);
  EXPECT_NE(refusal(keep_in(many)).find("more than 200 corners"), std::string::npos);
}

TEST(RegionKeys, AreReadBackFromAMissionFile) {
  boost::property_tree::ptree mission;
  mission.put("seed", "1");
  mission.put("region.keep_in", "box 0 0 0 9 9 9");
  mission.put("region.max_home_distance", "30 m");
  const auto region = region_in("mission.info", mission);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->limits().max_home_m, 30);
  EXPECT_EQ(region->limits().margin_m, RegionKeys{}.margin_m);
  mission.put("region.keep_on", "box 0 0 0 9 9 9");
  EXPECT_THROW(region_in("mission.info", mission), InputError);
}

}  // namespace
}  // namespace karst::core
