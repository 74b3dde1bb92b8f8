#include "sdk/evaluation/decisions/clock.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include "core_stack/common/format_text.h"
#include "core_stack/common/units.h"

namespace karst::evaluation {
namespace {

/// A number without a sign that is the whole text.
template <class Number>
std::optional<Number> plain_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool begins_with_digit = !text.empty() && text.front() >= '0' && text.front() <= '9';
  if (!begins_with_digit || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A number without a sign, then nothing or a unit of time.
std::optional<double> seconds_of_duration(std::string_view text) {
  const std::size_t last_digit = text.find_last_of("0123456789.");
  if (last_digit == std::string_view::npos) return std::nullopt;
  const auto number = plain_number<double>(text.substr(0, last_digit + 1));
  std::string_view unit = text.substr(last_digit + 1);
  if (!number || unit.empty()) return number;
  unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
  const auto factor = core::unit_factor(unit, "s");
  return factor ? std::optional(*number * *factor) : std::nullopt;
}

}  // namespace

std::optional<double> seconds_of_clock(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return seconds_of_duration(text);
  const auto minutes = plain_number<int>(std::string_view(text).substr(0, colon));
  const auto seconds = plain_number<double>(std::string_view(text).substr(colon + 1));
  if (!minutes || !seconds || !(*seconds < 60)) return std::nullopt;
  return 60.0 * *minutes + *seconds;
}

std::string clock_text(double t_s) {
  const long long hundredths = std::llround(100 * std::abs(t_s));
  return core::format_text("%s%lld:%02lld.%02lld", t_s < 0 ? "-" : "", hundredths / 6000,
                           hundredths / 100 % 60, hundredths % 100);
}

}  // namespace karst::evaluation
