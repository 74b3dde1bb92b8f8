// Surveys for tests after adjustment, which takes cavern, and where their stations are.
#pragma once
#include "sdk/survey/read_survey.h"
#include "tests/unit/survey/survey_files.h"

namespace karst::test {

inline const std::string kNormal = "data normal from to length compass clino\n";

inline survey::Survey adjusted(const std::string& text) {
  const Folder folder;
  return survey::read_survey(folder.write("s.th", text));
}
inline survey::Survey adjusted_lines(const std::string& lines) { return adjusted(centreline(lines)); }

/// Why these lines of a centreline are refused; empty if they are not.
inline std::string adjustment_refusal(const std::string& lines) {
  try {
    adjusted_lines(lines);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

/// Positions come to the centimetre.
inline void expect_at(const core::Vec3& a, const core::Vec3& b) {
  EXPECT_LT((a - b).norm(), 0.0051 * 1.8) << a.transpose() << " and " << b.transpose();
}

}  // namespace karst::test
