// Figures and drawings as PDF, made of their SVG by rsvg-convert (Debian: librsvg2-bin). A program that is
// called when it is there keeps cairo and pango out of karst's build, and what is drawn has one drawing
// instead of two.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace karst::evaluation {

/// rsvg-convert in one of the folders, which are separated by colons as in $PATH.
std::optional<std::filesystem::path> pdf_converter(const std::string& search_path);

/// Writes `pdf` completely or not at all; the same SVG gives the same bytes. Throws core::InputError with
/// what the program said.
void write_pdf(const std::filesystem::path& converter, const std::filesystem::path& svg,
               const std::filesystem::path& pdf);

}  // namespace karst::evaluation
