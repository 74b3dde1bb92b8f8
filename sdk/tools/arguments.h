// Validators of arguments that several commands use.
#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>

#include "sdk/tools/help/value_types.h"

namespace karst::tools {

/// An empty value such as `--policy ""` is a mistake, for example an unset shell variable, not the default.
inline CLI::Validator not_empty() {
  return {[](std::string& text) { return text.empty() ? std::string("is empty") : std::string(); }, ""};
}

/// A folder that exists or can be created.
inline CLI::Validator no_file() {
  return {[](std::string& path) {
            const bool other = std::filesystem::exists(path) && !std::filesystem::is_directory(path);
            return other ? path + " is a file; expected a folder" : std::string();
          },
          ""};
}

/// An unsigned whole number that fits into 64 bits (strtoull would wrap -1 around).
inline CLI::Validator whole_64_bits() {
  return {[](std::string& text) {
            std::uint64_t value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool good = error == std::errc() && end == text.data() + text.size();
            return good ? std::string() : "expected a whole number from 0 to 2^64 - 1, got \"" + text + "\"";
          },
          ""};
}

/// A number in a range. CLI::Range accepts "nan".
inline CLI::Validator number_in(double low, double high) {
  std::ostringstream range;
  range << low << " to " << high;
  return {[low, high, range = range.str()](std::string& text) {
            double value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool good =
                error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
            return good ? std::string() : "expected a number in " + range + ", got \"" + text + "\"";
          },
          "in " + range.str()};
}

}  // namespace karst::tools
