// `karst policy new`: what it writes is what the tutorials explain, and what it refuses.
#include <map>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

/// Among empty folders of policies: what this machine's user has installed is not the test's business.
Output policy_new(const std::string& arguments, const fs::path& home) {
  return run_command("HOME=" + home.string() + " XDG_DATA_HOME= " KARST_BINARY_DIR "/bin/karst policy new " +
                     arguments);
}

class Template : public ::testing::TestWithParam<const char*> {};

TEST_P(Template, IsTheTutorialsPolicy) {
  const std::string kind = GetParam(), name = "my_" + kind;
  const fs::path folder = fresh_folder("policy_new_" + kind);
  const Output out = policy_new(name + " --template " + kind + " --dir " + folder.string(), folder);
  ASSERT_EQ(out.code, 0) << out.text;
  const std::map<std::string, std::string> number{{"nearest", "1_"}, {"tour", "2_"}, {"memory", "3_"}};
  const fs::path example = fs::path(KARST_SOURCE_DIR) / "examples/policies" / (number.at(kind) + kind);
  for (const std::string& file : {name + ".cpp", name + "_test.cpp"})
    EXPECT_EQ(bytes_of(folder / name / file), bytes_of(example / file)) << file;
  // Beyond the example's, the build knows where this karst's SDK is.
  std::string cmake = bytes_of(folder / name / "CMakeLists.txt");
  const std::string hint = " HINTS [==[" KARST_BINARY_DIR "]==]";
  ASSERT_NE(cmake.find(hint), std::string::npos) << cmake;
  EXPECT_EQ(cmake.erase(cmake.find(hint), hint.size()), bytes_of(example / "CMakeLists.txt"));
  EXPECT_EQ(bytes_of(folder / name / "README.md").find("@"), std::string::npos) << "a place left unfilled";
}
INSTANTIATE_TEST_SUITE_P(All, Template, ::testing::Values("nearest", "tour", "memory"));

TEST(PolicyNew, InCIsTheExampleInC) {
  const fs::path folder = fresh_folder("policy_new_c"),
                 example = fs::path(KARST_SOURCE_DIR) / "examples/policies/plain_c";
  const Output out = policy_new("deepest --template c --dir " + folder.string(), folder);
  ASSERT_EQ(out.code, 0) << out.text;
  EXPECT_TRUE(out.says("deepest_test.c")) << out.text;
  for (const char* file : {"deepest.c", "deepest_test.c"})
    EXPECT_EQ(bytes_of(folder / "deepest" / file), bytes_of(example / file)) << file;
  std::string cmake = bytes_of(folder / "deepest/CMakeLists.txt");
  const std::string hint = " HINTS [==[" KARST_BINARY_DIR "]==]";
  ASSERT_NE(cmake.find(hint), std::string::npos) << cmake;
  EXPECT_EQ(cmake.erase(cmake.find(hint), hint.size()), bytes_of(example / "CMakeLists.txt"));
  const std::string readme = bytes_of(folder / "deepest/README.md");
  EXPECT_NE(readme.find("`deepest.c`"), std::string::npos) << readme;
  EXPECT_NE(readme.find("policy.parameters.max_path=50"), std::string::npos) << readme;
  EXPECT_NE(readme.find("`break deepest.c:decide`"), std::string::npos) << readme;
  EXPECT_EQ(readme.find("@"), std::string::npos) << "a place left unfilled";
}

TEST(PolicyNew, InPythonIsTheExampleInPython) {
  const fs::path folder = fresh_folder("policy_new_python"),
                 example = fs::path(KARST_SOURCE_DIR) / "examples/policies/python";
  const Output out = policy_new("my_nearest --template python --dir " + folder.string(), folder);
  ASSERT_EQ(out.code, 0) << out.text;
  EXPECT_TRUE(out.says("python my_nearest_test.py")) << out.text;
  for (const char* file : {"my_nearest.py", "my_nearest_test.py"})
    EXPECT_EQ(bytes_of(folder / "my_nearest" / file), bytes_of(example / file)) << file;
  EXPECT_FALSE(fs::exists(folder / "my_nearest/CMakeLists.txt"));
  EXPECT_EQ(bytes_of(folder / "my_nearest/README.md").find("@"), std::string::npos)
      << "a place left unfilled";
  for (const char* name : {"lambda", "karst", "numpy"}) {
    const Output refused =
        policy_new(std::string(name) + " --template python --dir " + folder.string(), folder);
    EXPECT_EQ(refused.code, 1) << name;
    EXPECT_TRUE(refused.says("is a word of Python, or a module that the policy needs")) << refused.text;
  }
}

// A name that is a word of the template's own code changes its texts only.
TEST(PolicyNew, InCTakesAnyName) {
  const fs::path folder = fresh_folder("policy_new_c_named");
  ASSERT_EQ(policy_new("create --template c --dir " + folder.string(), folder).code, 0);
  const std::string source = bytes_of(folder / "create/create.c"),
                    example = bytes_of(fs::path(KARST_SOURCE_DIR) / "examples/policies/plain_c/deepest.c");
  EXPECT_NE(source.find(".id = TEXT(\"create\")"), std::string::npos);
  EXPECT_NE(source.find(".name = TEXT(\"Create\")"), std::string::npos);
  std::size_t named = 0;
  for (std::size_t at = example.find("eepest"); at != std::string::npos; at = example.find("eepest", at + 1))
    ++named;
  EXPECT_EQ(named, 2u) << "only its id and its name";
}

TEST(PolicyNew, NamesEverythingAfterThePolicy) {
  const fs::path folder = fresh_folder("policy_new_named");
  ASSERT_EQ(policy_new("deep_first_2 --dir " + folder.string() + "/not/yet/there", folder).code, 0);
  const fs::path made = folder / "not/yet/there/deep_first_2";
  const std::string source = bytes_of(made / "deep_first_2.cpp");
  EXPECT_NE(source.find("class DeepFirst2 : public karst::Policy"), std::string::npos);
  EXPECT_NE(source.find("KARST_POLICY(DeepFirst2, \"deep_first_2\""), std::string::npos);
  for (const char* file : {"deep_first_2.cpp", "deep_first_2_test.cpp", "CMakeLists.txt", "README.md"}) {
    ASSERT_TRUE(fs::exists(made / file)) << file;
    EXPECT_EQ(bytes_of(made / file).find("my_nearest"), std::string::npos) << file;
  }
}

// It was a Release build: a debugger showed no line of it.
TEST(PolicyNew, BuildsWithDebugInformation) {
  const fs::path folder = fresh_folder("policy_new_debug");
  for (const char* kind : {"nearest", "c"}) {
    const std::string name = std::string("debugged_") + kind;
    ASSERT_EQ(policy_new(name + " --template " + kind + " --dir " + folder.string(), folder).code, 0);
    EXPECT_NE(bytes_of(folder / name / "CMakeLists.txt").find("set(CMAKE_BUILD_TYPE RelWithDebInfo)"),
              std::string::npos);
  }
  EXPECT_NE(bytes_of(folder / "debugged_nearest/README.md").find("`break DebuggedNearest::decide`"),
            std::string::npos);
}

class BadName : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BadName, IsRefusedWithAReasonAndNothingIsWritten) {
  const auto [name, reason] = GetParam();
  const fs::path folder = fresh_folder("policy_new_bad");
  const Output out = policy_new(std::string("--dir ") + folder.string() + "/made -- '" + name + "'", folder);
  EXPECT_EQ(out.code, 1) << out.text;
  EXPECT_TRUE(out.says(reason)) << out.text;
  EXPECT_FALSE(fs::exists(folder / "made"));
}
INSTANTIATE_TEST_SUITE_P(
    Names, BadName,
    ::testing::Values(
        std::pair("Deep", "[a-z][a-z0-9_]*"), std::pair("", "[a-z][a-z0-9_]*"),
        std::pair("2nd", "[a-z][a-z0-9_]*"), std::pair("-x", "[a-z][a-z0-9_]*"),
        std::pair("../up", "[a-z][a-z0-9_]*"), std::pair("h\xc3\xb6hle", "[a-z][a-z0-9_]*"),
        std::pair("new", "a word of C++ or of CMake"), std::pair("auto", "a word of C++ or of CMake"),
        std::pair("test", "a word of C++ or of CMake"),
        std::pair("a1234567890123456789012345678901234567890123456789012345678901234", "at most 64"),
        std::pair("nearest_frontier", "a policy of this name is there already: " KARST_BINARY_DIR)));

TEST(PolicyNew, LeavesAFolderThatIsThereAsItIs) {
  const fs::path folder = fresh_folder("policy_new_twice");
  fs::create_directories(folder / "mine");
  std::ofstream(folder / "mine/mine.cpp") << "my work";
  const Output out = policy_new("mine --dir " + folder.string(), folder);
  EXPECT_EQ(out.code, 1);
  EXPECT_TRUE(out.says((folder / "mine").string() + ": is there already")) << out.text;
  EXPECT_EQ(bytes_of(folder / "mine/mine.cpp"), "my work");
}

TEST(PolicyNew, SaysWhereItCannotWrite) {
  const fs::path folder = fresh_folder("policy_new_nowhere");
  std::ofstream(folder / "file") << "no folder";
  Output out = policy_new("mine --dir " + folder.string() + "/file", folder);
  EXPECT_EQ(out.code, 1);
  EXPECT_TRUE(out.says(folder.string() + "/file/mine: cannot be made: Not a directory")) << out.text;
  out = policy_new("mine --dir /proc/nowhere", folder);  // also root may not
  EXPECT_EQ(out.code, 1);
  EXPECT_TRUE(out.says("/proc/nowhere/mine: cannot be made: ")) << out.text;
}

TEST(PolicyNew, NamesTheTemplatesThereAre) {
  const Output out = policy_new("mine --template best", fresh_folder("policy_new_template"));
  EXPECT_EQ(out.code, 1);
  EXPECT_TRUE(out.says("nearest or tour or memory or c")) << out.text;
}

}  // namespace
}  // namespace karst
