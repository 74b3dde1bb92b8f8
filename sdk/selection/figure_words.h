// Figures for people: what they are in words, and their values with sensible digits and units.
#pragma once
#include <string>

namespace karst::selection {

/// "coverage averaged over the flight" for coverage_auc; the name itself if there are no words for it.
std::string metric_words(const std::string& metric);

/// "72 %" of a share, "1440 m³", "20.7 Wh", "65 s".
std::string metric_value_text(const std::string& metric, double value);

/// The value with about three digits, and no power of ten.
std::string plain_number(double value);

/// The value rounded to three digits, with a comma before each group of three: "0.54", "80", "6,910".
std::string rounded_number(double value);

/// A share as a percentage that is 0 or 100 only if the share is: "72 %", "<1 %", ">99 %".
std::string share_text(double share);

}  // namespace karst::selection
