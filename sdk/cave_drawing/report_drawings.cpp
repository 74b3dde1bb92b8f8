#include "sdk/cave_drawing/report_drawings.h"

#include <cstddef>
#include <exception>
#include <optional>
#include <string>

#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/cave_drawing/map_drawings.h"
#include "sdk/cave_drawing/run_record.h"
#include "sdk/cave_drawing/svg_sheet.h"

namespace karst::cave_drawing {
namespace {

namespace fs = std::filesystem;

// 115 m of passages take 80 kB, 790 m take 200 kB.
constexpr std::size_t kMostInReport_bytes = 2'000'000;

const char* report_title(View view) {
  switch (view) {
    case View::plan:
      return "Plan";
    case View::extended_profile:
      return "Extended profile";
    case View::projected_profile:
      return "Projected profile";
  }
  return "";
}

std::optional<fs::path> map_of_run(const fs::path& run) {
  for (const char* name : {"map.bt", "map.ot"})
    if (fs::is_regular_file(run / name)) return run / name;
  return std::nullopt;
}

evaluation::ReportDrawings drawn_for_report(const fs::path& run, const fs::path& map) {
  const std::string file = map.filename().string();
  const CaveDrawings drawings =
      map_drawings(core::read_octomap(map.string()), flight_record(run), std::nullopt, file);
  evaluation::ReportDrawings report;
  std::size_t size_bytes = 0;
  for (const Drawing* drawing : {&drawings.plan, &drawings.extended, &drawings.projected}) {
    const std::string title = report_title(drawing->view);
    if (drawing->spaces.empty() && drawing->centreline.empty()) {
      report.note +=
          (report.note.empty() ? "" : " ") + title + ": left out, no passage is wide enough for it.";
      continue;
    }
    report.pages.push_back({title, svg_sheet(*drawing, drawings.facts, {}, file)});
    size_bytes += report.pages.back().svg.size();
  }
  if (size_bytes > kMostInReport_bytes)
    return {{}, "The drawings are too large for this page. karst draw RUN --out FILE writes them."};
  return report;
}

}  // namespace

evaluation::ReportDrawings report_drawings(const fs::path& run) {
  try {
    const auto map = map_of_run(run);
    if (!map) return {{}, "No drawings: the run holds no map.bt, which a flight writes at its end."};
    return drawn_for_report(run, *map);
  } catch (const std::exception& e) {  // of a damaged map or one too large, and of memory that is not there
    return {{}, std::string("No drawings: ") + e.what()};
  }
}

}  // namespace karst::cave_drawing
