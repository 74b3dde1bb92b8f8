// Which files are taken for policies in another language, and what is said of those that are none.
#include "sdk/host/plugin/script_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core_stack/common/error.h"
#include "sdk/host/plugin/selection.h"

namespace karst::host {
namespace {

namespace fs = std::filesystem;

class ScriptFile : public ::testing::Test {
 protected:
  ScriptFile() : folder_(fs::temp_directory_path() / ("karst-script-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~ScriptFile() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

std::string refusal(const std::string& file) {
  try {
    policy_in_file(file);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST_F(ScriptFile, IsKnownByItsEnding) {
  EXPECT_TRUE(is_script("mine.py"));
  for (const char* other : {"mine.so", "mine", "mine.pyc", "mine.py.txt"})
    EXPECT_FALSE(is_script(other)) << other;
}

TEST_F(ScriptFile, InAFolderOnlyWhatDefinesAPolicyIsOpened) {
  EXPECT_TRUE(may_hold_policy(write("a.py", "import karst\n\nclass A(karst.Policy):\n    pass\n")));
  EXPECT_TRUE(may_hold_policy(write("b.py", "from karst import Policy\nclass B ( Base, Policy ) :\n")));
  EXPECT_TRUE(may_hold_policy(write("c.py", "def decide(request):\n    return []\n")));
  EXPECT_FALSE(may_hold_policy(write("d.py", "from a import A\n\ndef test_a():\n    assert A\n")));
  EXPECT_FALSE(may_hold_policy(write("e.py", "# class A(karst.Policy):\n")));
  EXPECT_FALSE(may_hold_policy(write("f.py", "")));
  EXPECT_FALSE(may_hold_policy(folder_ / "none.py"));
}

TEST_F(ScriptFile, ANameIsNoFile) {
  EXPECT_FALSE(policy_in_file("nearest_frontier"));
  EXPECT_FALSE(policy_in_file("auto"));
}

TEST_F(ScriptFile, AFileWithOnePolicyGivesItsName) {
  const std::string file = write("far.py",
                                 "import karst\n\nclass Far(karst.Policy):\n    '''Far.'''\n    def "
                                 "decide(self, r):\n        return []\n");
  std::string policy = file;
  std::vector<std::string> plugins{"other.so"};
  take_policy_file(policy, plugins);
  EXPECT_EQ(policy, "far");
  EXPECT_EQ(plugins, (std::vector<std::string>{file, "other.so"}));
  EXPECT_EQ(list_policies({{}, {folder_.string()}}).size(), 1u) << "and is found in a folder";
}

TEST_F(ScriptFile, WhatIsWrongIsSaidWithFileAndLine) {
  EXPECT_NE(refusal((folder_ / "none.py").string()).find("there is no such file"), std::string::npos);
  const auto says = [&](const std::string& text, const std::string& part) {
    const std::string said = refusal(write("bad.py", text).string());
    EXPECT_NE(said.find("bad.py: " + part), std::string::npos) << said;
  };
  says("import karst\nclass A(karst.Policy)\n", "bad.py, line 2: SyntaxError");
  says("import no_such_module\n", "ModuleNotFoundError: No module named 'no_such_module' (bad.py, line 1");
  says("x = 1\n", "holds no policy");
  const std::string body = "    def decide(self, r):\n        return []\n";
  says("import karst\nclass A(karst.Policy):\n" + body + "class B(karst.Policy):\n" + body,
       "holds several policies: name one of a, b");
}

}  // namespace
}  // namespace karst::host
