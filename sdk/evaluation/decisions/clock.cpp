#include "sdk/evaluation/decisions/clock.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include "core_stack/common/format_text.h"

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

}  // namespace

std::optional<double> seconds_of_clock(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return plain_number<double>(text);
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
