// A CSV file read by column name. Runs may end abruptly: truncated or damaged rows are left out and reported.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace karst::evaluation {

struct Table {
  std::size_t rows = 0;
  std::map<std::string, std::vector<double>> numbers;    // empty cells and "nan" are NaN
  std::map<std::string, std::vector<std::string>> text;  // the columns requested as text

  /// The column, or null if the file has none of this name.
  const std::vector<double>* column(const std::string& name) const;
  /// The times in seconds: column t_s or time_s.
  const std::vector<double>* times() const;
};

/// A missing file is an empty table. Unreadable rows are left out; for each cause one sentence with the file
/// and the first line is added to `problems`.
Table read_table(const std::filesystem::path& file, const std::vector<std::string>& text_columns,
                 std::vector<std::string>& problems);

}  // namespace karst::evaluation
