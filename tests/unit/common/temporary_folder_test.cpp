// A folder that is there as long as it is needed.
#include "core_stack/common/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace karst::core {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsRemovedWithAllThatIsInIt) {
  fs::path path;
  {
    const TemporaryFolder folder("purpose");
    path = folder.path();
    EXPECT_TRUE(path.filename().string().starts_with("karst-purpose-")) << path;
    fs::create_directories(path / "a/b");
    std::ofstream(path / "a/b/file") << "text";
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TemporaryFolder, EachIsAnotherOneAndOfItsOwnerAlone) {
  const TemporaryFolder a("test"), b("test");
  EXPECT_NE(a.path(), b.path());
  EXPECT_EQ(fs::status(a.path()).permissions(), fs::perms::owner_all);
}

TEST(TemporaryFolder, MayBeGoneBefore) {
  const TemporaryFolder folder("test");
  fs::remove(folder.path());
}

TEST(TemporaryFolder, OneThatCannotBeMadeIsNamed) {
  try {
    const TemporaryFolder folder("no/such/folder");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("no/such/folder"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("cannot be made"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace karst::core
