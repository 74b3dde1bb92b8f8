// Times of a flight as people read them off a clock.
#pragma once
#include <optional>
#include <string>

namespace karst::evaluation {

/// Seconds of "94", "94.5", "1:34", "1:34.5", "94 s" or "1.5min"; nothing if the text is no such time.
std::optional<double> seconds_of_clock(const std::string& text);

/// "1:34.50": minutes and seconds, to hundredths.
std::string clock_text(double t_s);

}  // namespace karst::evaluation
