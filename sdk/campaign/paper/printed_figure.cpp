#include "sdk/campaign/paper/printed_figure.h"

#include <cctype>
#include <cmath>

#include "core_stack/common/unit_text.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {

PrintedFigure printed_figure(int metric) {
  const auto& figure = evaluation::metric_definitions()[static_cast<std::size_t>(metric)];
  const std::string subject = subject_of(figure), unit = core::unit_text(figure.unit);
  PrintedFigure printed{subject, subject, unit, unit, 1, figure.better};
  if (subject.find('_') == std::string::npos)  // a key has no capital
    printed.heading.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(subject.front())));
  if (is_fraction(figure))
    printed.unit = "%", printed.difference_unit = "percentage points", printed.factor = 100;
  return printed;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " (" + unit + ")";
}

std::string printed_number(double v, int decimals) {
  if (!std::isfinite(v)) return "\u2013";
  const std::string text = fixed_text(v, decimals);
  return text.starts_with('-') ? "\u2212" + text.substr(1) : text;
}

}  // namespace karst::campaign
