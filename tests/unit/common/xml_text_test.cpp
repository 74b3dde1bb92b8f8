#include "core_stack/common/xml_text.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

TEST(XmlText, EndsNeitherAnElementNorAnAttribute) {
  EXPECT_EQ(xml_text("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(xml_text("plain, Höhle"), "plain, Höhle");
  EXPECT_EQ(xml_text(""), "");
}

TEST(XmlText, HasNoControlCharacters) { EXPECT_EQ(xml_text("a\x1b[2Jb"), "a?[2Jb"); }

}  // namespace
}  // namespace karst::core
