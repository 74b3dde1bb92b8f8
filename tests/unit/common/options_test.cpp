#include "core_stack/common/options.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <boost/property_tree/info_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/units.h"

namespace karst::core {
namespace {

struct Camera {
  double fov_rad = 1.0;
  std::int64_t rows = 120;
};
void describe(OptionTable& t, Camera& o) {
  t.add("fov", o.fov_rad, "rad", 0.1, 3.2, "field of view");
  t.add("rows", o.rows, 1, 4000, "rows of pixels");
}

enum class Light { none, flood };
constexpr auto names_of(Light) {
  using enum Light;
  return std::to_array<Named<Light>>({{none, "dark"}, {flood, "flood"}});
}

struct Options {
  double speed_mps = 2;
  double share = 0.5;
  std::int64_t count = 3;
  bool on = true;
  std::string mode = "near";
  std::string name = "bat";
  Light light = Light::flood;
  Camera camera;
};
void describe(OptionTable& t, Options& o) {
  t.add("max_speed", o.speed_mps, "m/s", 0.1, 10, "speed limit");
  t.add("share", o.share, "", 0, 1, "a plain number");
  t.add("count", o.count, -5, 1000, "how many");
  t.add("on", o.on, "whether");
  t.add("mode", o.mode, {"near", "far", "highest"}, "which");
  t.add("name", o.name, {}, "any text");
  t.add("light", o.light, "of the lamp");
  t.section("camera", o.camera);
}

struct Table {
  Options o;
  OptionTable t;
  Table() { describe(t, o); }
};

std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

std::string error_of_setting(const std::string& key, const std::string& text) {
  Table table;
  return error_of([&] { table.t.set("a.info", key, text); });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

boost::property_tree::ptree parsed(const std::string& info) {
  std::istringstream in(info);
  boost::property_tree::ptree tree;
  boost::property_tree::read_info(in, tree);
  return tree;
}

TEST(Options, UnitsOfOneDimensionAreConverted) {
  Table x;
  x.t.set("", "max_speed", "3.6 km/h");
  EXPECT_NEAR(x.o.speed_mps, 1.0, 1e-12);
  x.t.set("", "max_speed", "2 km/h");
  EXPECT_NEAR(x.o.speed_mps, 2 / 3.6, 1e-12);
  x.t.set("", "max_speed", "2m/s");
  EXPECT_EQ(x.o.speed_mps, 2);
  x.t.set("", "max_speed", " 1.5 ");
  EXPECT_EQ(x.o.speed_mps, 1.5);
  x.t.set("", "camera.fov", "90 deg");
  EXPECT_NEAR(x.o.camera.fov_rad, std::numbers::pi / 2, 1e-12);
}

TEST(Options, AllKindsOfValuesAreRead) {
  Table x;
  x.t.read(
      "a.info",
      parsed(
          "count -2\non false\nmode far\nname \"two words\"\nlight dark\ncamera { rows 64 }\nshare 1e-3\n"));
  EXPECT_EQ(x.o.count, -2);
  EXPECT_FALSE(x.o.on);
  EXPECT_EQ(x.o.mode, "far");
  EXPECT_EQ(x.o.name, "two words");
  EXPECT_EQ(x.o.light, Light::none);
  EXPECT_EQ(x.o.camera.rows, 64);
  EXPECT_EQ(x.o.share, 1e-3);
  EXPECT_EQ(x.o.speed_mps, 2) << "what is not given keeps its default";
}

TEST(Options, AnUnknownKeyNamesFileKeyAndTheNearestOne) {
  const std::string e = error_of_setting("max_sped", "1");
  EXPECT_TRUE(contains(e, "a.info")) << e;
  EXPECT_TRUE(contains(e, "max_sped")) << e;
  EXPECT_TRUE(contains(e, "did you mean max_speed?")) << e;
  EXPECT_TRUE(contains(error_of_setting("fov", "1"), "did you mean camera.fov?"))
      << "right name, wrong section";
  EXPECT_FALSE(contains(error_of_setting("zzzzqqqq", "1"), "did you mean")) << "nothing is near";
}

TEST(Options, WrongUnitsSayWhatWasExpected) {
  const std::string e = error_of_setting("max_speed", "2 kg");
  EXPECT_TRUE(contains(e, "\"kg\" is no unit for it")) << e;
  EXPECT_TRUE(contains(e, "a number in 0.1 to 10 m/s")) << e;
  EXPECT_TRUE(contains(error_of_setting("max_speed", "2 parsecs"), "no unit")) << "no such unit at all";
  EXPECT_TRUE(contains(error_of_setting("share", "0.5 m"), "this key has no unit"));
  EXPECT_TRUE(contains(error_of_setting("camera.rows", "64 m"), "this key has no unit"));
}

TEST(Options, ValuesOutOfRangeAreRefusedAfterConversion) {
  EXPECT_TRUE(contains(error_of_setting("max_speed", "11"), "0.1 to 10 m/s"));
  EXPECT_EQ(error_of_setting("max_speed", "30 km/h"), "no error");
  EXPECT_NE(error_of_setting("max_speed", "37 km/h"), "no error");
  EXPECT_NE(error_of_setting("camera.rows", "0"), "no error");
  EXPECT_NE(error_of_setting("count", "1001"), "no error");
}

TEST(Options, TextThatIsNoValueIsRefused) {
  for (const char* text : {"", "fast", "nan", "inf", "1,5", "1 2", "--1", "m/s", "0x10"})
    EXPECT_NE(error_of_setting("max_speed", text), "no error") << text;
  EXPECT_TRUE(contains(error_of_setting("camera.rows", "1.5"), "a whole number"));
  for (const char* text : {"yes", "1", "True", ""})
    EXPECT_NE(error_of_setting("on", text), "no error") << text;
  const std::string e = error_of_setting("mode", "highst");
  EXPECT_TRUE(contains(e, "one of near far highest")) << e;
  EXPECT_TRUE(contains(e, "did you mean highest?")) << e;
}

TEST(Options, TheChoicesOfAnEnumerationAreItsNames) {
  const std::string e = error_of_setting("light", "flod");
  EXPECT_TRUE(contains(e, "one of dark flood, got \"flod\"; did you mean flood?")) << e;
  EXPECT_TRUE(contains(Table().t.help(), "light = flood"));
}

TEST(Options, AnEnumerationMayHaveNoDefault) {
  std::optional<Light> light;
  OptionTable t;
  t.add("light", light, "");
  EXPECT_EQ(t.resolved().get<std::string>("light"), "");
  t.set("a.info", "light", "dark");
  EXPECT_EQ(light, Light::none);
}

TEST(EnumNames, OfAValueAndBack) {
  for (const Named<Light>& n : names_of(Light{})) {
    EXPECT_STREQ(name_of(n.value), n.name);
    EXPECT_EQ(parse<Light>(n.name), n.value);
  }
  EXPECT_FALSE(parse<Light>("none"));
  EXPECT_STREQ(name_of(static_cast<Light>(7)), "unknown");
}

TEST(Options, ARefusedValueLeavesTheOldOne) {
  Table x;
  EXPECT_THROW(x.t.set("", "max_speed", "99"), InputError);
  EXPECT_EQ(x.o.speed_mps, 2);
}

TEST(Options, AKeyGivenTwiceIsAnError) {
  Table x;
  const std::string e = error_of([&] { x.t.read("a.info", parsed("count 1\ncount 2\n")); });
  EXPECT_TRUE(contains(e, "count: given twice")) << e;
  EXPECT_TRUE(
      contains(error_of([&] { x.t.read("a.info", parsed("camera { rows 2 }\ncamera { rows 3 }\n")); }),
               "camera.rows: given twice"));
}

TEST(Options, ASectionWhereAValueBelongsIsAnError) {
  Table x;
  EXPECT_NE(error_of([&] { x.t.read("a.info", parsed("count { deep 1 }\n")); }), "no error");
  EXPECT_NE(error_of([&] { x.t.read("a.info", parsed("camera 7\n")); }), "no error");
  const std::string e = error_of_setting("camera", "7");
  EXPECT_TRUE(contains(e, "a.info: camera: a section of keys (camera.")) << e;
}

TEST(Options, SyntaxErrorsNameTheLine) {
  const std::string path = testing::TempDir() + "karst_options_test.info";
  std::ofstream(path) << "count 1\ncamera {\n  rows 3\n}\n}\n";
  const std::string e = error_of([&] { read_info(path); });
  EXPECT_TRUE(contains(e, path + ": line 5")) << e;
  EXPECT_TRUE(contains(error_of([] { read_info("/no/such/file.info"); }), "/no/such/file.info"));
  std::remove(path.c_str());
}

TEST(Options, HelpNamesEveryKeyWithUnitRangeAndDefault) {
  Table x;
  const std::string help = x.t.help();
  for (const auto& row : x.t.rows()) {
    EXPECT_TRUE(contains(help, row.key + " = " + value_text(row))) << row.key;
    EXPECT_TRUE(contains(help, row.help));
  }
  EXPECT_TRUE(contains(help, "0.1 to 10 m/s"));
}

RC_GTEST_PROP(Options, ResolvedValuesReadBackIdentically,
              (double speed, double share, std::int64_t count, bool on, unsigned mode)) {
  Table x;
  const auto into = [](double v, double low, double high) {
    return std::isfinite(v) ? low + (high - low) * std::abs(std::sin(v)) : low;
  };
  x.o.speed_mps = into(speed, 0.1, 10);
  x.o.share = into(share, 0, 1);
  x.o.count = std::abs(count % 1000);
  x.o.on = on;
  x.o.mode = std::vector<std::string>{"near", "far", "highest"}[mode % 3];
  x.o.light = mode % 2 == 0 ? Light::none : Light::flood;
  x.o.camera.fov_rad = into(speed + share, 0.1, 3.2);
  std::ostringstream file;
  boost::property_tree::write_info(file, x.t.resolved());
  Table y;
  y.t.read("resolved.info", parsed(file.str()));
  RC_ASSERT(y.o.speed_mps == x.o.speed_mps);  // to the last bit
  RC_ASSERT(y.o.share == x.o.share);
  RC_ASSERT(y.o.count == x.o.count);
  RC_ASSERT(y.o.on == x.o.on);
  RC_ASSERT(y.o.mode == x.o.mode);
  RC_ASSERT(y.o.light == x.o.light);
  RC_ASSERT(y.o.camera.fov_rad == x.o.camera.fov_rad);
  RC_ASSERT(y.t.resolved() == x.t.resolved());
}

RC_GTEST_PROP(Options, AnyTextIsEitherReadOrRefused, (const std::string& key, const std::string& text)) {
  Table x;
  for (const std::string& k :
       {key, std::string("max_speed"), std::string("camera.rows"), std::string("mode")}) {
    try {
      x.t.set("any.info", k, text);
    } catch (const InputError& e) {
      RC_ASSERT(std::string(e.what()).starts_with("any.info: "));
    }
  }
  RC_ASSERT(x.o.speed_mps >= 0.1 && x.o.speed_mps <= 10);
  RC_ASSERT(x.o.camera.rows >= 1 && x.o.camera.rows <= 4000);
}

TEST(NearestName, PrefersTheLeastEdits) {
  EXPECT_EQ(nearest_name("resolutoin", {"range", "resolution", "rows"}), "resolution");
  EXPECT_EQ(nearest_name("xyz", {"resolution"}), "");
  EXPECT_EQ(nearest_name("", {}), "");
}

TEST(OptionTable, EditDistanceCountsInsertedDeletedAndReplacedCharacters) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("time", "cave"), 3u);
}

TEST(Units, FactorsMatchTheirDefinitions) {
  EXPECT_DOUBLE_EQ(unit_factor("km/h", "m/s").value(), 1 / 3.6);
  EXPECT_DOUBLE_EQ(unit_factor("deg", "rad").value(), std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(unit_factor("min", "s").value(), 60);
  EXPECT_DOUBLE_EQ(unit_factor("m", "cm").value(), 100);
  EXPECT_DOUBLE_EQ(unit_factor("ft", "in").value(), 12);
  EXPECT_FALSE(unit_factor("m", "s").has_value());
  EXPECT_FALSE(unit_factor("m/s", "rad/s").has_value());
  EXPECT_FALSE(unit_factor("furlong", "m").has_value());
}

}  // namespace
}  // namespace karst::core
