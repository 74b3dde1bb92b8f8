#include "core_stack/common/options.h"

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <charconv>
#include <cmath>
#include <numeric>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/former_keys.h"
#include "core_stack/common/units.h"

namespace karst::core {
namespace {

namespace pt = boost::property_tree;
using Row = OptionTable::Row;

std::string range_text(const Row& row) {
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  return shortest_text(row.low) + " to " + shortest_text(row.high) + unit;
}

std::string expected_text(const Row& row) {
  if (std::holds_alternative<bool*>(row.target)) return "true or false";
  if (std::holds_alternative<std::string*>(row.target) ||
      std::holds_alternative<OptionTable::Choice>(row.target)) {
    if (row.choices.empty()) return "text";
    std::string all = "one of";
    for (const std::string& c : row.choices) all += " " + c;
    return all;
  }
  const std::string kind = std::holds_alternative<double*>(row.target) ? "a number" : "a whole number";
  return kind + " in " + range_text(row);
}

std::string trimmed(const std::string& s) {
  const auto a = s.find_first_not_of(" \t");
  if (a == std::string::npos) return "";
  return s.substr(a, s.find_last_not_of(" \t") - a + 1);
}

void collect_leaves(const pt::ptree& tree, const std::string& prefix,
                    std::vector<std::pair<std::string, std::string>>& out) {
  for (const auto& [name, child] : tree) {
    const std::string key = prefix + name;
    if (child.empty() || !child.data().empty()) out.emplace_back(key, child.data());
    collect_leaves(child, key + ".", out);
  }
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

std::string nearest_name(const std::string& key, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = 1 + last_part(key).size() / 2;  // a long section brings nothing nearer
  for (const std::string& c : candidates) {
    // A right name in the wrong section is the commonest slip: compare the last parts as well.
    const std::size_t d = std::min(edit_distance(key, c), edit_distance(last_part(key), last_part(c)) + 1);
    if (d < best_distance) {
      best_distance = d;
      best = c;
    }
  }
  return best;
}

std::string value_text(const Row& row) {
  struct Text {
    const Row& row;
    std::string operator()(const double* v) const {
      return shortest_text(*v) + (row.unit.empty() ? "" : " " + row.unit);
    }
    std::string operator()(const std::int64_t* v) const { return std::to_string(*v); }
    std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
    std::string operator()(const std::string* v) const { return *v; }
    std::string operator()(const OptionTable::Choice& c) const { return c.name(); }
  };
  return std::visit(Text{row}, row.target);
}

void OptionTable::add(std::string key, double& v, std::string unit, double low, double high,
                      std::string help) {
  rows_.push_back({prefix_ + std::move(key), &v, std::move(unit), low, high, {}, std::move(help)});
}
void OptionTable::add(std::string key, std::int64_t& v, double low, double high, std::string help) {
  rows_.push_back({prefix_ + std::move(key), &v, "", low, high, {}, std::move(help)});
}
void OptionTable::add(std::string key, bool& v, std::string help) {
  rows_.push_back({prefix_ + std::move(key), &v, "", 0, 0, {}, std::move(help)});
}
void OptionTable::add(std::string key, std::string& v, std::vector<std::string> choices, std::string help) {
  rows_.push_back({prefix_ + std::move(key), &v, "", 0, 0, std::move(choices), std::move(help)});
}
void OptionTable::add(std::string key, Choice choice, std::vector<std::string> choices, std::string help) {
  rows_.push_back(
      {prefix_ + std::move(key), std::move(choice), "", 0, 0, std::move(choices), std::move(help)});
}

void OptionTable::set(const std::string& source, const std::string& key, const std::string& raw) {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.key == key; });
  if (row == rows_.end()) {
    std::vector<std::string> keys;
    for (const Row& r : rows_) keys.push_back(r.key);
    const auto within =
        std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.starts_with(key + "."); });
    if (within != keys.end())
      throw InputError(source, key,
                       "a section of keys (" + *within + " and so on), not one that has a value");
    const std::string now = renamed(key);
    if (std::find(keys.begin(), keys.end(), now) != keys.end())
      throw InputError(source, key, "is now called " + now);
    const std::string near = nearest_name(key, keys);
    throw InputError(source, key, "no such key" + (near.empty() ? "" : "; did you mean " + near + "?"));
  }
  const std::string text = trimmed(raw);
  const auto bad = [&](const std::string& why) {
    throw InputError(source, key, "expected " + expected_text(*row) + ", got \"" + text + "\"" + why);
  };
  if (auto* const* flag = std::get_if<bool*>(&row->target)) {
    if (text != "true" && text != "false") bad("");
    **flag = text == "true";
    return;
  }
  if (!row->choices.empty() &&
      std::find(row->choices.begin(), row->choices.end(), text) == row->choices.end()) {
    // Names as short as those of units are all near to each other: "km" is no slip for "m".
    const bool short_names = std::all_of(row->choices.begin(), row->choices.end(),
                                         [](const std::string& c) { return c.size() <= 2; });
    const std::string near = short_names ? "" : nearest_name(text, row->choices);
    bad(near.empty() ? "" : "; did you mean " + near + "?");
  }
  if (auto* const* words = std::get_if<std::string*>(&row->target)) {
    **words = text;
    return;
  }
  if (const auto* choice = std::get_if<OptionTable::Choice>(&row->target)) return choice->choose(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) bad("");
  const std::string unit = trimmed(std::string(end, text.data() + text.size()));
  if (!unit.empty()) {
    const auto factor = unit_factor(unit, row->unit);
    if (!factor) bad(row->unit.empty() ? " (this key has no unit)" : " (\"" + unit + "\" is no unit for it)");
    value *= *factor;
  }
  if (value < row->low || value > row->high) bad("");
  if (auto* const* real = std::get_if<double*>(&row->target)) {
    **real = value;
  } else {
    if (value != std::floor(value)) bad("");
    *std::get<std::int64_t*>(row->target) = static_cast<std::int64_t>(value);
  }
}

void OptionTable::read(const std::string& source, const pt::ptree& tree) {
  std::vector<std::string> seen;
  for (const auto& [key, text] : leaves_of(tree)) {
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) throw InputError(source, key, "given twice");
    seen.push_back(key);
    set(source, key, text);
  }
}

pt::ptree OptionTable::resolved() const {
  pt::ptree tree;
  for (const Row& r : rows_) tree.put(r.key, value_text(r));
  return tree;
}

std::string OptionTable::help() const {
  std::ostringstream out;
  for (const Row& r : rows_) {
    out << "  " << r.key << " = " << value_text(r) << "\n      " << r.help << " (" << expected_text(r)
        << ")\n";
  }
  return out.str();
}

std::vector<std::pair<std::string, std::string>> leaves_of(const pt::ptree& tree) {
  std::vector<std::pair<std::string, std::string>> leaves;
  collect_leaves(tree, "", leaves);
  return leaves;
}

}  // namespace karst::core
