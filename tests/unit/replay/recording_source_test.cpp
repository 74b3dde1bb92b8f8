// What a name stands for: a bag, a folder of bags, a folder of scans, or nothing that can be replayed.
#include "plugins/replay/recording_source.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core_stack/common/error.h"
#include "tests/unit/replay/folder.h"

namespace karst::replay {
namespace {

using test::Folder;

std::string source_error_of(const std::string& path) {
  try {
    open_source(path, "");
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "opened";
}

TEST(RecordingSource, ANameThatIsWrongIsNoFolderOfScans) {
  Folder dir;
  const std::string fifo = (dir.path() / "fifo.bag").string(), none = (dir.path() / "flihgt.mcap").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(source_error_of(fifo), fifo + ": is a FIFO, not a regular file");
  EXPECT_EQ(source_error_of(none), none + ": no such bag, and no such folder of scans");
}

TEST(RecordingSource, AFolderWithScansAndBagsIsAmbiguous) {
  Folder dir;
  const std::string folder = dir.path().string();
  EXPECT_NE(source_error_of(folder).find("and no bag (.bag, .mcap, .db3)"), std::string::npos)
      << source_error_of(folder);
  dir.write("000.pcd", "x");
  dir.write("a.mcap", "x");
  EXPECT_EQ(source_error_of(folder), folder + ": holds scans and bags: name the bag");
}

}  // namespace
}  // namespace karst::replay
