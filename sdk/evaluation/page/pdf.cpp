#include "sdk/evaluation/page/pdf.h"

#include <unistd.h>

#include <sstream>

#include "core_stack/common/error.h"
#include "sdk/host/isolation/process.h"

namespace karst::evaluation {

namespace fs = std::filesystem;

std::optional<fs::path> pdf_converter(const std::string& search_path) {
  std::istringstream folders(search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty()) continue;  // the folder of work, from which nothing should be run unasked
    const fs::path program = fs::path(folder) / "rsvg-convert";
    std::error_code no_matter;
    if (fs::is_regular_file(program, no_matter) && access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

void write_pdf(const fs::path& converter, const fs::path& svg, const fs::path& pdf) {
  constexpr double kLimit_s = 120;
  const fs::path part = fs::absolute(pdf.string() + ".part");
  // Without SOURCE_DATE_EPOCH the file would tell when it was made.
  const host::ProcessOutput made =
      host::run_process({"/usr/bin/env", "SOURCE_DATE_EPOCH=0", fs::absolute(converter).string(), "--format",
                         "pdf", "--output", part.string(), fs::absolute(svg).string()},
                        kLimit_s);
  std::error_code error, no_matter;
  const bool good = !made.end.hung && made.end.signal == 0 && made.end.exit_code == 0;
  if (good) fs::rename(part, pdf, error);
  if (good && !error) return;
  fs::remove(part, no_matter);
  throw core::InputError(pdf.string(), "",
                         "cannot be made: " + (good ? error.message()
                                                    : converter.string() + ": " + host::describe(made.end) +
                                                          (made.out.empty() ? "" : ": " + made.out)));
}

}  // namespace karst::evaluation
