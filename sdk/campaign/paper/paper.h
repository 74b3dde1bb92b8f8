// `karst results CAMPAIGN --paper FOLDER`: a campaign's tables, figures and methods for a paper.
// docs/compare.md
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sdk/campaign/store/store.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// The files as text, by name: tables and methods as .tex and .md, figures as .svg. The same results give the
/// same bytes. Without a second contestant there are no comparisons and no differences, without curves no
/// coverage. Throws core::InputError if no flight has ended, or if there is no such figure.
std::map<std::string, std::string> paper_texts(const ResultsWithExtras& campaign,
                                               const VerdictOptions& options);

enum class IfThere { refuse, overwrite };

struct PaperOptions {
  std::string metric;  // the primary figure; "": as the campaign declared
  IfThere if_there = IfThere::refuse;
  std::string search_path;  // $PATH, for rsvg-convert
};
struct PaperFiles {
  std::vector<std::filesystem::path> written;
  bool with_pdf = false;  // false: there is no rsvg-convert
};

/// Writes the files into `folder`, which is made if need be, with a .pdf of each .svg. Refuses before it
/// writes anything if a file is there already. Throws core::InputError.
PaperFiles write_paper(const std::filesystem::path& folder_or_store, const std::filesystem::path& folder,
                       const PaperOptions& options);

}  // namespace karst::campaign
