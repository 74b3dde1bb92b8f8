#include "sdk/tools/table_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "core_stack/common/json_file.h"
#include "sdk/evaluation/team/run_ending.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/help/value_types.h"

namespace karst::tools {
namespace {

struct Column {
  const char *key, *title, *format;
  double factor;
};
constexpr std::array kColumns = {
    Column{"explored_volume_m3", "explored m³", "%.0f", 1},
    Column{"coverage", "coverage %", "%.1f", 100},
    Column{"path_length_m", "path m", "%.0f", 1},
    Column{"flight_time_s", "time s", "%.0f", 1},
    Column{"mean_speed_mps", "mean m/s", "%.2f", 1},
    Column{"exploring_speed_mps", "exploring m/s", "%.2f", 1},
    Column{"standing_share", "standing %", "%.1f", 100},
    Column{"longest_stall_s", "stall s", "%.1f", 1},
    Column{"min_clearance_m", "clearance m", "%.2f", 1},
    Column{"tracking_rms_m", "tracking m", "%.3f", 1},
    Column{"landing_error_m", "landed off m", "%.2f", 1},
    Column{"battery_left", "battery %", "%.0f", 100},
    Column{"map_error_mean_m", "map error m", "%.3f", 1},
    Column{"map_error_std_m", "its std m", "%.3f", 1},
    Column{"drift_percent", "drift %", "%.3f", 1},
    Column{"heading_error_rad", "heading deg", "%.2f", 180 / std::numbers::pi},
};

/// A run in progress has no figures yet; for damaged figures `problem` gives the reason.
nlohmann::json metrics_of(const std::string& run, std::string& problem) {
  namespace fs = std::filesystem;
  const auto row = [&run](const char* outcome) {
    return nlohmann::json{{"cave", run}, {"outcome", outcome}, {"no_figures", true}};
  };
  if (!fs::is_directory(run)) {
    problem = run + ": no such run directory";
    return row("no such run");
  }
  const fs::path file = fs::path(run) / "metrics.json";
  if (!fs::exists(file)) return row("no metrics.json");
  auto metrics = core::json_of_file(file);
  if (metrics.is_object()) {
    if (!metrics.contains("cave")) metrics["cave"] = run;
    return metrics;
  }
  problem = file.string() + ": is no JSON object";
  return row("damaged metrics.json");
}

std::string text_of(const nlohmann::json& metrics, const char* key) {
  const auto value = metrics.find(key);
  if (value == metrics.end() || value->is_null()) return "-";
  return value->is_string() ? value->get<std::string>() : value->dump();
}

std::optional<double> number_of(const nlohmann::json& metrics, const Column& column) {
  const auto value = metrics.find(column.key);
  if (value == metrics.end() || !value->is_number()) return std::nullopt;
  return column.factor * value->get<double>();
}

/// The columns for which at least one run has a number.
std::vector<Column> known_columns(const std::vector<nlohmann::json>& runs) {
  std::vector<Column> known;
  std::copy_if(kColumns.begin(), kColumns.end(), std::back_inserter(known), [&runs](const Column& c) {
    return std::any_of(runs.begin(), runs.end(),
                       [&c](const nlohmann::json& m) { return number_of(m, c).has_value(); });
  });
  return known;
}

std::string text_of(const std::optional<double>& number, const Column& column) {
  if (!number) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), column.format, *number);
  return text.data();
}

/// The value that this fraction of the sorted values does not exceed (nearest rank); the least for 0.
std::optional<double> quantile(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return std::nullopt;
  const double rank = std::ceil(fraction * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

/// How the run ended, as a cell of a Markdown table; "" if its events do not tell.
std::string ending_cell(const std::string& run) {
  std::string text = evaluation::read_ending(run).sentence;
  for (char& c : text) {  // either would end the cell
    if (c == '|') c = '/';
    if (c == '\n') c = ' ';
  }
  return text;
}

/// The kind of a folder that is not a run, such as a campaign's; "" for a run.
std::string no_run(const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path path = folder;
  if (!fs::is_directory(path) || fs::exists(path / "mission.info") || fs::exists(path / "metrics.json"))
    return "";
  return folder + (fs::exists(path / "campaign.sqlite") ? ": a campaign; see karst results " + folder
                                                        : ": no run directory");
}

/// Prints the spread of the figures over all runs that have some, in five lines of the same table.
void print_spread(const std::vector<nlohmann::json>& runs, const std::vector<Column>& columns) {
  std::map<std::string, int> outcomes;
  for (const nlohmann::json& m : runs) ++outcomes[text_of(m, "outcome")];
  std::string counted;
  for (const auto& [outcome, count] : outcomes)
    counted += (counted.empty() ? "" : ", ") + std::to_string(count) + " " + outcome;
  std::vector<std::vector<double>> sorted;
  for (const Column& c : columns) {
    std::vector<double>& values = sorted.emplace_back();
    for (const nlohmann::json& m : runs)
      if (const auto v = number_of(m, c)) values.push_back(*v);
    std::sort(values.begin(), values.end());
  }
  for (const auto& [title, fraction] :
       {std::pair{"least", 0.0}, std::pair{"5 %", 0.05}, std::pair{"median", 0.5}, std::pair{"95 %", 0.95},
        std::pair{"greatest", 1.0}}) {
    std::string line = std::string("| **") + title + "** | of " + std::to_string(runs.size()) + " | | " +
                       (fraction == 0 ? counted : "") + " |";
    for (std::size_t i = 0; i < columns.size(); ++i)
      line += " " + text_of(quantile(sorted[i], fraction), columns[i]) + " |";
    print_out("%s |\n", line.c_str());
  }
}

}  // namespace

void add_table_command(CLI::App& app) {
  CLI::App* table = app.add_subcommand("table",
                                       "Print the figures of finished runs, and how they spread, as a "
                                       "Markdown table\n\n  karst table runs/*/");
  auto runs = std::make_shared<std::vector<std::string>>();
  table->add_option("runs", *runs, "run directories")->type_name(kFolder)->required();
  table->callback([runs] {
    struct Row {
      std::string run;
      nlohmann::json metrics;
    };
    std::vector<std::string> problems;
    std::vector<Row> rows;
    std::vector<nlohmann::json> all;  // that have figures
    std::vector<std::string> skipped;
    for (const std::string& run : *runs) {
      if (const std::string what = no_run(run); !what.empty()) {
        skipped.push_back(what);
        continue;
      }
      std::string problem;
      const nlohmann::json m = metrics_of(run, problem);
      if (!problem.empty()) problems.push_back(problem);
      if (!m.contains("no_figures")) all.push_back(m);
      rows.push_back({run, m});
    }
    const std::vector<Column> columns = known_columns(all);
    std::string head = "| cave | policy | seed | outcome |", rule = "|---|---|---|---|";
    for (const Column& c : columns) {
      head += std::string(" ") + c.title + " |";
      rule += "---:|";
    }
    print_out("%s ended |\n%s---|\n", head.c_str(), rule.c_str());
    for (const Row& row : rows) {
      std::string line = "|";
      for (const char* key : {"cave", "policy", "seed", "outcome"})
        line += " " + text_of(row.metrics, key) + " |";
      for (const Column& c : columns) line += " " + text_of(number_of(row.metrics, c), c) + " |";
      print_out("%s %s |\n", line.c_str(), ending_cell(row.run).c_str());
    }
    if (all.size() > 1) print_spread(all, columns);
    std::fflush(stdout);
    for (const std::string& p : problems) print_wrapped(stderr, 7, "karst: %s\n", p.c_str());
    for (const std::string& p : skipped) print_error("karst: passed over: %s\n", p.c_str());
    if (!problems.empty() || skipped.size() == runs->size()) throw CLI::RuntimeError(1);
  });
}

}  // namespace karst::tools
