// Options: each module has one plain struct with defaults and one `describe` function that names every
// field with unit, range and a line of help. Reading, validation, help and the resolved mission file
// all come from that one table.
//
//   struct MapOptions { double resolution_m = 0.2; };
//   inline void describe(OptionTable& t, MapOptions& o) {
//     t.add("resolution", o.resolution_m, "m", 0.05, 1.0, "edge length of a map cell");
//   }
#pragma once
#include <boost/property_tree/ptree_fwd.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace karst::core {

class OptionTable {
 public:
  /// A field whose type is an enumeration, by the names of its values.
  struct Choice {
    std::function<std::string()> name;
    std::function<void(const std::string&)> choose;  // one of the row's choices
  };
  struct Row {
    std::string key;
    std::variant<double*, std::int64_t*, bool*, std::string*, Choice> target;
    std::string unit;  // "" for a plain number
    double low = 0, high = 0;
    std::vector<std::string> choices;  // for text and enumerations: the values allowed, empty for any
    std::string help;
  };

  void add(std::string key, double& v, std::string unit, double low, double high, std::string help);
  void add(std::string key, std::int64_t& v, double low, double high, std::string help);
  void add(std::string key, bool& v, std::string help);
  void add(std::string key, std::string& v, std::vector<std::string> choices, std::string help);
  template <NamedEnum E>
  void add(std::string key, E& v, std::string help) {
    add(std::move(key),
        Choice{[&v] { return name_of(v); }, [&v](const std::string& name) { v = *parse<E>(name); }},
        all_names<E>(), std::move(help));
  }
  /// The same of one that has no default.
  template <NamedEnum E>
  void add(std::string key, std::optional<E>& v, std::string help) {
    add(std::move(key),
        Choice{[&v] { return v ? name_of(*v) : ""; }, [&v](const std::string& name) { v = parse<E>(name); }},
        all_names<E>(), std::move(help));
  }
  /// What `fill` adds stands below `prefix.`; keys become "prefix.key".
  template <class Fill>
  void under(const std::string& prefix, Fill fill) {
    const std::string outer = prefix_;
    prefix_ += prefix + ".";
    fill(*this);
    prefix_ = outer;
  }
  /// A module's table below `prefix.`.
  template <class Options>
  void section(const std::string& prefix, Options& o) {
    under(prefix, [&o](OptionTable& t) { describe(t, o); });
  }

  const std::vector<Row>& rows() const { return rows_; }

  /// Sets one value from text such as "2", "2 m/s" or "90 deg" (units of the same dimension are
  /// converted). Throws InputError naming `source`, the key, what was expected, and the nearest key.
  void set(const std::string& source, const std::string& key, const std::string& text);

  /// Every leaf of `tree` is set; the tree's paths are the table's keys.
  void read(const std::string& source, const boost::property_tree::ptree& tree);

  /// All values as resolved, in the table's order.
  boost::property_tree::ptree resolved() const;
  /// Help: a line an option with unit, range and default (the value as it is now).
  std::string help() const;

 private:
  void add(std::string key, Choice choice, std::vector<std::string> choices, std::string help);

  std::vector<Row> rows_;
  std::string prefix_;
};

/// Text of a row's current value with its unit, as `set` reads it.
std::string value_text(const OptionTable::Row& row);

/// The least number of characters to be inserted, deleted or replaced (Levenshtein, 1966).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The candidate with the least edit distance to `key`, or "" if none is near.
std::string nearest_name(const std::string& key, const std::vector<std::string>& candidates);

/// Paths and values of a tree's leaves in its order: ("map.resolution", "0.2 m"). A node with a value of its
/// own counts as a leaf, too.
std::vector<std::pair<std::string, std::string>> leaves_of(const boost::property_tree::ptree& tree);

/// Reads an INFO file, whoever wrote it; throws InputError ("FILE: line N: reason") on what is no INFO, has
/// an #include, or goes beyond the bounds of info_lines.h. See info_reader.h.
boost::property_tree::ptree read_info(const std::string& path);

}  // namespace karst::core
