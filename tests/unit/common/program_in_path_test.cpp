// Which files count as programs.
#include "core_stack/common/program_in_path.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "core_stack/common/temporary_folder.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

class ProgramInPath : public testing::Test {
 protected:
  ~ProgramInPath() override {
    setenv("PATH", before_.c_str(), 1);
    fs::current_path(there_);
  }
  static void set_path(const std::string& path) { setenv("PATH", path.c_str(), 1); }
  fs::path folder(const char* name) const {
    fs::create_directories(work_.path() / name);
    return work_.path() / name;
  }
  static std::string file(const fs::path& path, bool executable) {
    std::ofstream(path) << "#!/bin/sh\n";
    fs::permissions(path, executable ? fs::perms::owner_all : fs::perms::owner_read | fs::perms::owner_write);
    return path.string();
  }

 private:
  const TemporaryFolder work_{"test"};
  const std::string before_ = getenv("PATH") != nullptr ? getenv("PATH") : "";
  const fs::path there_ = fs::current_path();
};

TEST_F(ProgramInPath, TheFirstFolderThatHasItCounts) {
  const fs::path a = folder("a"), b = folder("b"), c = folder("c");
  const std::string first = file(b / "tool", true);
  file(c / "tool", true);
  set_path(a.string() + ":" + b.string() + ":" + c.string());
  EXPECT_EQ(program_in_path("tool"), first);
  EXPECT_FALSE(program_in_path("other"));
}

TEST_F(ProgramInPath, AFolderAndAFileThatMayNotBeExecutedArePassedOver) {
  const fs::path a = folder("a"), b = folder("b"), c = folder("c");
  folder("a/tool");
  file(b / "tool", false);
  set_path(a.string() + ":" + b.string());
  EXPECT_FALSE(program_in_path("tool"));
  const std::string program = file(c / "tool", true);
  set_path(a.string() + ":" + b.string() + ":" + c.string());
  EXPECT_EQ(program_in_path("tool"), program);
}

TEST_F(ProgramInPath, ALinkCountsIfWhatItLeadsToDoes) {
  const fs::path a = folder("a"), b = folder("b");
  fs::create_symlink(file(b / "real", true), a / "tool");
  fs::create_symlink(b / "none", a / "broken");
  set_path(a.string());
  EXPECT_EQ(program_in_path("tool"), (a / "tool").string());
  EXPECT_FALSE(program_in_path("broken"));
}

TEST_F(ProgramInPath, AnEmptyEntryIsNotTheCurrentFolder) {
  const fs::path a = folder("a");
  file(a / "tool", true);
  fs::current_path(a);
  for (const char* path : {"", ":", "::/nowhere", "/nowhere:"}) {
    set_path(path);
    EXPECT_FALSE(program_in_path("tool")) << path;
  }
  unsetenv("PATH");
  EXPECT_FALSE(program_in_path("tool"));
}

}  // namespace
}  // namespace karst::core
