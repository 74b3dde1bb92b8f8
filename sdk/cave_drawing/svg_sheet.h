// A drawing as a page to print.
#pragma once
#include <string>

#include "sdk/cave_drawing/drawing.h"
#include "sdk/cave_drawing/sheet.h"

namespace karst::cave_drawing {

/// A whole SVG file in millimetres: the drawing in its frame, and a title block with name, figures, scale,
/// scale bar and, on a plan, the north arrow. Throws core::InputError that names `file`.
std::string svg_sheet(const Drawing& drawing, const CaveFacts& facts, const SheetOptions& options,
                      const std::string& file);

}  // namespace karst::cave_drawing
