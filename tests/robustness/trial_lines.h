// The campaign's results: a JSON object a line and trial, appended as trials end.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/robustness/judge.h"
#include "tests/robustness/trial.h"

namespace karst::robustness {

struct TrialLine {
  int trial = 0;
  std::string build;  // what flew, such as a commit
  std::string cave_kind, cave, policy, vehicle, fault, fault_text;
  Verdict verdict;
  int exit_code = 0;
  double wall_s = 0;
};

TrialLine line_of(const Trial& trial, const Verdict& verdict, const host::ProcessEnd& end,
                  const std::string& build);

std::string to_json(const TrialLine& line);
/// None if the text is no such line.
std::optional<TrialLine> from_json(const std::string& text);

/// Whole lines only: a campaign killed in mid-line loses that one. Of a trial that was flown again, the last.
std::vector<TrialLine> read_trials(const std::filesystem::path& file);

}  // namespace karst::robustness
