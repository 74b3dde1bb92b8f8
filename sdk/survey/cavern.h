// Runs Survex's programs: `cavern` closes the loops of a survey, `dump3d` prints what it made.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace karst::survey {

/// Whether Survex is installed.
bool has_survex();

/// What cavern said of a line of its input.
struct CavernMessage {
  std::string file, text;
  std::size_t line = 0;  // 0: of the whole survey
  bool error = false;
  std::vector<std::string> unattached;  // stations of parts that hang on no fixed station
};
struct CavernRun {
  bool closed = false;  // it wrote the survey
  std::vector<CavernMessage> messages;
  std::filesystem::path three_d, err;  // its .3d and .err files
};
/// Runs cavern on a survey, with its output in `folder`. Throws core::InputError naming `shown_as` (if that
/// is empty, `file`) if Survex is missing, takes longer than five minutes or writes more than it should.
CavernRun run_cavern(const std::string& file, const std::filesystem::path& folder,
                     const std::string& shown_as = "");

/// The text that dump3d prints of a .3d or .plt file, into `folder`. Throws as run_cavern() does, and if
/// dump3d cannot read the file.
std::filesystem::path run_dump3d(const std::string& file, const std::filesystem::path& folder,
                                 const std::string& shown_as = "");

/// The messages in what cavern printed.
std::vector<CavernMessage> cavern_messages(const std::string& output);

}  // namespace karst::survey
