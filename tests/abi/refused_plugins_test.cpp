// Plugins that must not be loaded, each with the text a user reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "sdk/host/plugin/plugin_file.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(RefusedPlugin, LibraryWithoutEntryIsNoPlugin) {
  EXPECT_THAT(load_error("no_entry"),
              AllOf(HasSubstr("no_entry.so"), HasSubstr("exports no karst_plugin_entry")));
}

TEST(RefusedPlugin, AnotherMajorSaysBothVersionsAndWhatToDo) {
  EXPECT_THAT(load_error("wrong_major"),
              AllOf(HasSubstr("ABI 2.0"), HasSubstr("offers 1.0"), HasSubstr("rebuild the plugin"),
                    HasSubstr("use a karst of ABI 2")));
}

TEST(RefusedPlugin, NewerMinorSaysBothVersionsAndWhatToDo) {
  EXPECT_THAT(load_error("newer_minor"),
              AllOf(HasSubstr("ABI 1.7"), HasSubstr("offers 1.0"), HasSubstr("install a newer karst")));
}

TEST(RefusedPlugin, NewerHostWantedSaysBothReleases) {
  EXPECT_THAT(load_error("newer_host_wanted"),
              AllOf(HasSubstr("needs karst 99.0.0"), HasSubstr("this is 0.")));
}

TEST(RefusedPlugin, MissingSlotIsNamed) {
  EXPECT_THAT(load_error("missing_slot"), HasSubstr("no \"decide\""));
}

TEST(RefusedPlugin, SlotBeyondTheTablesSizeIsMissing) {
  EXPECT_THAT(load_error("short_table"), HasSubstr("no \"destroy\""));
}

TEST(RefusedPlugin, ParameterWhoseDefaultIsOutOfItsRange) {
  EXPECT_THAT(load_error("bad_default"),
              AllOf(HasSubstr("parameter 0"), HasSubstr("default is out of range")));
}

TEST(RefusedPlugin, CrashAtLoadCostsAChildProcessOnly) {
  EXPECT_THAT(load_error("crash_at_load"), HasSubstr("crash_at_load.so: crashes when opened"));
}

TEST(RefusedPlugin, ExitAtLoadCostsAChildProcessOnly) {
  EXPECT_THAT(load_error("exit_at_load"), HasSubstr("ended the process when opened"));
}

TEST(RefusedPlugin, PipeIsNotWaitedFor) {
  const auto pipe = std::filesystem::temp_directory_path() / "karst_pipe.so";
  std::filesystem::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(host::enter_plugin(pipe.string()), core::InputError);
  for (const host::Isolation isolation : {host::Isolation::in_process, host::Isolation::process}) {
    host::PolicyChoice c = choice_of("plain");
    c.isolation = isolation;
    try {
      host::load_policy(c, {{pipe.string()}, {}});
      ADD_FAILURE() << "it was opened";
    } catch (const core::InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr("not a regular file"));
    }
  }
  std::filesystem::remove(pipe);
}

TEST(RefusedPlugin, TextFileIsNoSharedObject) {
  const auto file = std::filesystem::temp_directory_path() / "karst_text_file.so";
  std::ofstream(file) << "not a library\n";
  try {
    host::load_policy(choice_of("plain"), {{file.string()}, {}});
    FAIL() << "a text file was loaded";
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("cannot be opened"), HasSubstr(file.string())));
  }
  std::filesystem::remove(file);
}

TEST(RefusedPlugin, MissingFileSaysSo) {
  EXPECT_THAT(load_error("there_is_no_such_plugin"), HasSubstr("cannot be opened"));
}

TEST(RefusedPlugin, InitThatThrowsGivesItsReason) {
  host::PolicyChoice c = choice_of("throwing_init");
  c.parameters.put("fail", "init");
  try {
    load("throwing_init", c);
    FAIL() << "init() threw, and yet it was loaded";
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("these parameters do not go together"));
  }
}

TEST(PolicyName, UnknownOneNamesTheNearestAllThereAreAndTheFolders) {
  const std::string folder = std::string(KARST_BINARY_DIR) + "/lib/karst/policies";
  try {
    host::load_policy(choice_of("nearest_fronter"), {{}, {folder, "/no/such/folder"}});
    FAIL() << "a policy nobody wrote was loaded";
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("nearest_fronter"), HasSubstr("did you mean nearest_frontier"),
                                HasSubstr("unknown_ratio"), HasSubstr(folder), HasSubstr("/no/such/folder")));
  }
}

TEST(Parameters, UnknownKeyNamesTheNearest) {
  host::PolicyChoice c = choice_of("plain");
  c.parameters.put("setp", "2 m");
  try {
    load("plain", c);
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("test.info"), HasSubstr("policy.parameters.setp"),
                                HasSubstr("did you mean policy.parameters.step?")));
  }
}

TEST(Parameters, WrongUnitAndRangeSayWhatWasExpected) {
  for (const char* text : {"2 kg", "11 m", "2000 cm", "lots"}) {
    host::PolicyChoice c = choice_of("plain");
    c.parameters.put("step", text);
    try {
      load("plain", c);
      FAIL() << text;
    } catch (const core::InputError& e) {
      EXPECT_THAT(e.what(), AllOf(HasSubstr("step"), HasSubstr("0.1 to 10 m")));
    }
  }
}

TEST(Parameters, UnitsAreConvertedAndReachThePolicy) {
  host::PolicyChoice c = choice_of("plain");
  c.parameters.put("step", "150 cm");
  const auto policy = load("plain", c);
  Room room;
  EXPECT_DOUBLE_EQ(policy->decide(room.request).goals.at(0).position.x(), 7.0);
  EXPECT_EQ(policy->parameters().get<std::string>("step"), "1.5 m");
}

TEST(Discovery, BrokenPluginsAreListedWithTheirReasonAndHideNoOther) {
  const host::SearchPath path{
      {plugin_file("crash_at_load"), plugin_file("wrong_major"), plugin_file("plain")}, {}};
  const auto all = host::list_policies(path);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_THAT(all[0].broken, HasSubstr("crashes when opened"));
  EXPECT_THAT(all[1].broken, HasSubstr("ABI 2.0"));
  EXPECT_EQ(all[2].id, "plain");
  EXPECT_EQ(all[2].version, "1.2.3");
  EXPECT_EQ(all[2].abi, "1.0");
  ASSERT_EQ(all[2].parameters.size(), 1u);
  EXPECT_EQ(all[2].parameters[0].unit, "m");
}

TEST(Discovery, PluginThatHangsWhenOpenedIsBroken) {
  const host::SearchPath path{{plugin_file("hang_at_load")}, {}, 0.3};
  EXPECT_THAT(host::list_policies(path).at(0).broken, HasSubstr("hangs"));
}

TEST(Discovery, TheFirstFileThatOffersANameWins) {
  const auto all = host::list_policies({{plugin_file("plain"), plugin_file("nan_goal")}, {}});
  EXPECT_EQ(all.at(0).shadowed_by, "");
  EXPECT_EQ(all.at(1).shadowed_by, plugin_file("plain"));
  const auto policy =
      host::load_policy(choice_of("plain"), {{plugin_file("plain"), plugin_file("nan_goal")}, {}});
  EXPECT_EQ(policy->file(), plugin_file("plain"));
}

TEST(Discovery, WhatAPluginWritesToStdoutIsDropped) {
  ::testing::internal::CaptureStdout();
  const auto all = host::list_policies({{plugin_file("talkative")}, {}});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(all.at(0).broken, "");
}

TEST(Discovery, EnvironmentComesBeforeTheUsersFolderAndThatBeforeTheInstalledOne) {
  setenv("KARST_PLUGIN_PATH", "/first:/second", 1);
  setenv("XDG_DATA_HOME", "/data", 1);
  const host::SearchPath path = host::default_search_path({"a.so"});
  unsetenv("KARST_PLUGIN_PATH");
  unsetenv("XDG_DATA_HOME");
  EXPECT_EQ(path.files, std::vector<std::string>{"a.so"});
  ASSERT_EQ(path.folders.size(), 4u);
  EXPECT_EQ(path.folders[0], "/first");
  EXPECT_EQ(path.folders[1], "/second");
  EXPECT_EQ(path.folders[2], "/data/karst/policies");
  EXPECT_EQ(path.folders[3], std::string(KARST_BINARY_DIR) + "/lib/karst/policies");
}

}  // namespace
}  // namespace karst::test
