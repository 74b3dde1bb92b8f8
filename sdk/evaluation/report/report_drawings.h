// Drawings of the cave on the page of a run. Evaluation draws nothing itself: they come from its callers.
#pragma once
#include <string>
#include <vector>

namespace karst::evaluation {

struct ReportDrawing {
  std::string title;
  std::string svg;  // one SVG element: a page to print
};

struct ReportDrawings {
  std::vector<ReportDrawing> pages;
  std::string note;  // why there are none, or fewer
};

}  // namespace karst::evaluation
