// Survex files that include each other in a circle.
#include "sdk/survey/include_cycle.h"

#include "tests/unit/survey/survey_files.h"

namespace karst::survey {
namespace {

using test::Folder;
using test::says;

std::string refusal_of_includes(const std::string& file) {
  try {
    refuse_include_cycles(file);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(IncludeCycle, AFileThatIncludesItselfIsNamedWithItsLine) {
  const Folder folder;
  const std::string said = refusal_of_includes(folder.write("self.svx", "*begin x\n*include self\n*end x\n"));
  EXPECT_TRUE(says(said, "self.svx: line 2: *include self: the file includes itself")) << said;
}

TEST(IncludeCycle, ACircleOfFilesIsNamedWhereItCloses) {
  const Folder folder;
  folder.write("b.svx", "; *include a\n  * INCLUDE \"A.SVX\" ; back\n");
  const std::string said = refusal_of_includes(folder.write("a.svx", "1 2 10 0 0\n*include b.svx\n"));
  EXPECT_TRUE(says(said, "b.svx: line 2: *include A.SVX: that file includes this one, in a circle")) << said;
}

TEST(IncludeCycle, AFileIncludedTwiceAndOneThatIsNotThereAreNone) {
  const Folder folder;
  folder.write("c.svx", "1 2 10 0 0\n*includes c\n");
  folder.write("b.svx", "*include c\n");
  EXPECT_EQ(refusal_of_includes(folder.write("a.svx", "*include b\n*include c\n*include b\n*include none\n")),
            "");
  EXPECT_EQ(refusal_of_includes((folder.path() / "nowhere.svx").string()), "");
}

}  // namespace
}  // namespace karst::survey
