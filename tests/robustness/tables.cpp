#include "tests/robustness/tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>

namespace karst::robustness {
namespace {

std::vector<double> sorted_clearances(const std::vector<TrialLine>& trials) {
  std::vector<double> all;
  for (const TrialLine& t : trials)
    if (t.verdict.least_clearance_m) all.push_back(*t.verdict.least_clearance_m);
  std::sort(all.begin(), all.end());
  return all;
}

/// The least value that at least this share of the sorted values does not exceed.
double quantile(const std::vector<double>& sorted, double fraction) {
  const auto n = static_cast<double>(sorted.size());
  const auto rank = static_cast<std::size_t>(std::max(0.0, std::ceil(fraction * n) - 1));
  return sorted[std::min(rank, sorted.size() - 1)];
}

std::string row(const std::string& name, const std::vector<TrialLine>& trials,
                const std::function<bool(const TrialLine&)>& counted) {
  const auto count = [&](auto&& holds) {
    return std::count_if(trials.begin(), trials.end(),
                         [&](const TrialLine& t) { return counted(t) && holds(t); });
  };
  std::string text = "| " + name + " | " + std::to_string(count([](const TrialLine&) { return true; }));
  for (const Outcome o : kOutcomes)
    text += " | " + std::to_string(count([o](const TrialLine& t) { return t.verdict.outcome == o; }));
  return text + " |\n";
}

std::string table(const std::string& title, const std::vector<TrialLine>& trials,
                  const std::function<std::string(const TrialLine&)>& key) {
  std::string text = "| " + title + " | trials", rule = "|---|---:";
  for (const Outcome o : kOutcomes) text += std::string(" | ") + name_of(o), rule += "|---:";
  text += " |\n" + rule + "|\n";
  std::set<std::string> keys;
  for (const TrialLine& t : trials) keys.insert(key(t));
  for (const std::string& k : keys) text += row(k, trials, [&](const TrialLine& t) { return key(t) == k; });
  return text + row("**all**", trials, [](const TrialLine&) { return true; }) + "\n";
}

}  // namespace

std::string summary(const std::vector<TrialLine>& trials) {
  std::string text = table("cave", trials, [](const TrialLine& t) { return t.cave_kind; }) +
                     table("fault", trials, [](const TrialLine& t) { return t.fault; });
  double in_air_s = 0;
  for (const TrialLine& t : trials) in_air_s += t.verdict.in_air_s;
  char line[400];
  std::snprintf(line, sizeof line, "%.1f hours in the air.\n", in_air_s / 3600);
  text += line;
  if (const auto c = sorted_clearances(trials); !c.empty()) {
    std::snprintf(
        line, sizeof line,
        "\nLeast clearance of %zu flights, m:\n\n| least | 1 %% | 5 %% | 25 %% | median | 75 %% | 95 %% | "
        "greatest |\n|---|---|---|---|---|---|---|---|\n| %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f "
        "| %.2f |\n",
        c.size(), c.front(), quantile(c, 0.01), quantile(c, 0.05), quantile(c, 0.25), quantile(c, 0.5),
        quantile(c, 0.75), quantile(c, 0.95), c.back());
    text += line;
  }
  text += "\n";
  for (const TrialLine& t : trials)
    if (is_bad(t.verdict.outcome))
      text += "- " + std::to_string(t.trial) + " (" + t.build + ") " + t.cave + ", " + t.policy + ", " +
              t.vehicle + ", " + t.fault + " (" + t.fault_text + "): " + name_of(t.verdict.outcome) + "; " +
              t.verdict.reason + "\n";
  return text;
}

std::string clearance_plot(const std::vector<TrialLine>& trials) {
  constexpr double kWidth = 640, kHeight = 320, kLeft = 50, kBottom = 280, kTop = 20, kMax_m = 1.5;
  const auto x = [](double clearance_m) { return kLeft + (kWidth - kLeft - 20) * clearance_m / kMax_m; };
  const auto y = [](double fraction) { return kBottom - (kBottom - kTop) * fraction; };
  char text[300];
  const auto print = [&text](const char* format, auto... values) {
    std::snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  std::string svg = print(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
      kWidth, kHeight);
  for (int i = 0; i <= 15; i += 3)
    svg += print(
        "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"295\" text-anchor=\"middle\">"
        "%.1f</text>\n",
        x(0.1 * i), kTop, kBottom, x(0.1 * i), 0.1 * i);
  for (int i = 0; i <= 4; ++i)
    svg += print(
        "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#ddd\"/><text x=\"44\" y=\"%.1f\" text-anchor=\"end\">%d"
        "%%</text>\n",
        kLeft, y(0.25 * i), kWidth - 20, y(0.25 * i) + 4, 25 * i);
  const auto c = sorted_clearances(trials);
  std::string path;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double at = x(std::clamp(c[i], 0.0, kMax_m)), n = static_cast<double>(c.size());
    if (i == 0) path = print("M%.1f %.1f", at, y(0));
    path += print("H%.1fV%.1f", at, y(static_cast<double>(i + 1) / n));
  }
  svg += "<path fill=\"none\" stroke=\"#1f5fbf\" stroke-width=\"2\" d=\"" + path + "\"/>\n";
  svg += print(
      "<text x=\"%.0f\" y=\"314\" text-anchor=\"middle\">least clearance of the hull from rock, m; share "
      "of %zu flights</text>\n</svg>\n",
      kWidth / 2, c.size());
  return svg;
}

}  // namespace karst::robustness
