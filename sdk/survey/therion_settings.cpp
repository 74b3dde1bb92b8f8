#include "sdk/survey/therion_settings.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/printable.h"
#include "sdk/survey/survey_tree.h"

namespace karst::survey {
namespace {

std::string quoted(const std::string& word) { return "'" + core::printable(word) + "'"; }

/// The quantities that begin behind the command, and the first word that is none.
struct Quantities {
  std::vector<Quantity> all;
  std::size_t next = 1;
};
Quantities quantities_behind(const std::vector<std::string>& words) {
  Quantities found;
  for (; found.next < words.size(); ++found.next) {
    const std::vector<Quantity> meant = quantities_of(words[found.next]);
    if (meant.empty()) break;
    found.all.insert(found.all.end(), meant.begin(), meant.end());
  }
  return found;
}

/// Why these cannot be set together, if they cannot.
Refusal check_kind(const Quantities& found) {
  if (found.all.empty()) return std::nullopt;
  for (const Quantity q : found.all)
    if (is_angle(q) != is_angle(found.all.front())) return "lengths and angles have no unit in common";
  return std::nullopt;
}

void set_unit(Settings& settings, Quantity quantity, const LengthScale& length, const AngleScale& angle) {
  if (quantity == Quantity::bearing)
    settings.bearing = angle;
  else if (quantity == Quantity::gradient)
    settings.gradient = angle;
  else
    settings.lengths[static_cast<std::size_t>(quantity)] = length;
}

void set_deviation_of(Conditions& conditions, Quantity quantity, std::optional<double> value) {
  switch (quantity) {
    case Quantity::length:
      conditions.tape_m = value;
      break;
    case Quantity::bearing:
      conditions.compass_deg = value;
      break;
    case Quantity::gradient:
      conditions.clino_deg = value;
      break;
    case Quantity::depth:
      conditions.depth_m = value;
      break;
    case Quantity::easting:
      conditions.east_m = value;
      break;
    case Quantity::northing:
      conditions.north_m = value;
      break;
    case Quantity::altitude:
      conditions.up_m = value;
      break;
    default:
      break;  // of counters and positions: nothing is weighted with it
  }
}

}  // namespace

std::optional<std::string> Settings::station_name(const std::string& word) const {
  if (word.empty() || word == "." || word == "-" || word.size() > kMaxStationName) return std::nullopt;
  const std::size_t at = std::min(word.find('@'), word.size());
  if (at == 0) return std::nullopt;
  return name_prefix + word.substr(0, at) + name_suffix + word.substr(at);
}

double Settings::metres_between(Quantity q, double first, double second) const {
  const Calibration& c = calibration(q);
  return lengths[static_cast<std::size_t>(q)].metres(c.corrected(second) -
                                                     (c.corrected(first) - c.corrected(0)));
}

Refusal set_units(const std::vector<std::string>& words, Settings& settings) {
  const Quantities found = quantities_behind(words);
  if (found.next >= words.size()) return "units lacks a quantity or a unit";
  if (const Refusal mixed = check_kind(found)) return mixed;
  double factor = 1;
  std::size_t next = found.next;
  if (next + 2 == words.size())
    if (const auto number = number_of(words[next]); number && std::isfinite(*number)) {
      factor = *number;
      ++next;
    }
  if (factor == 0) return "the factor of a unit cannot be zero";
  if (next + 1 != words.size()) return "is no quantity of units: " + quoted(words[next]);
  const std::string& unit = words.back();
  const auto metres = metres_of_unit(unit);
  const auto angle = angle_unit(unit);
  if (!metres && !angle) return "is no unit: " + quoted(unit);
  for (const Quantity q : found.all) {
    if (is_angle(q) ? !angle : !metres) return "is no unit of " + words[1] + ": " + quoted(unit);
    if (q == Quantity::bearing && angle->percent) return "a bearing cannot be a percentage";
    set_unit(settings, q, {metres.value_or(1), factor}, {angle.value_or(AngleUnit{}), factor});
  }
  return std::nullopt;
}

Refusal set_calibration(const std::vector<std::string>& words, Settings& settings) {
  const Quantities found = quantities_behind(words);
  if (found.all.empty())
    return words.size() > 1 ? "is no quantity: " + quoted(words[1]) : "calibrate lacks a quantity";
  const CalibrationWords read = calibration_of(words, found.next);
  if (!read.error.empty()) return core::printable(read.error);
  for (const Quantity q : found.all) settings.calibrations[static_cast<std::size_t>(q)] = read.calibration;
  return std::nullopt;
}

Refusal set_deviation(const std::vector<std::string>& words, Settings& settings) {
  const Quantities found = quantities_behind(words);
  if (found.all.empty() || found.next >= words.size()) return "sd lacks a quantity or a value";
  if (const Refusal mixed = check_kind(found)) return mixed;
  const auto number = number_of(words[found.next]);
  if (!number || std::isinf(*number) || *number <= 0)
    return "is no standard deviation: " + quoted(words[found.next]);
  std::optional<double> value;
  if (!std::isnan(*number)) {
    if (found.next + 2 != words.size()) return "sd is a value and a unit";
    const std::string& unit = words.back();
    const auto metres = metres_of_unit(unit);
    const auto angle = angle_unit(unit);
    if (is_angle(found.all.front()) ? !angle : !metres)
      return "is no unit of " + words[1] + ": " + quoted(unit);
    value = is_angle(found.all.front()) ? AngleScale{*angle, 1}.degrees(*number) : *number * *metres;
  }
  for (const Quantity q : found.all) set_deviation_of(settings.conditions, q, value);
  return std::nullopt;
}

Refusal set_flags(const std::vector<std::string>& words, Settings& settings) {
  bool on = true;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "not") {
      if (!on || i + 1 == words.size()) return "'not' is followed by a flag";
      on = false;
      continue;
    }
    if (word == "surface")
      settings.surface = on;
    else if (word == "duplicate")
      settings.duplicate = on;
    else if (word == "splay")
      settings.splay = on;
    else if (word == "approximate" || word == "approx")
      settings.approximate = on;
    else
      return "is no flag of a leg: " + quoted(word);
    on = true;
  }
  return std::nullopt;
}

Refusal set_infer(const std::vector<std::string>& words, Settings& settings) {
  if (words.size() != 3 || (words[1] != "plumbs" && words[1] != "equates") ||
      (words[2] != "on" && words[2] != "off"))
    return "infer takes plumbs or equates, and on or off";
  (words[1] == "plumbs" ? settings.infer_plumbs : settings.infer_equates) = words[2] == "on";
  return std::nullopt;
}

double Declinations::at(const std::optional<YearRange>& years) const {
  if (by_year.table.empty() || (!years && undated)) return undated.value_or(0);
  if (years) return by_year.corrected(years->middle());
  return by_year.corrected((by_year.table.front().first + by_year.table.back().first) / 2);
}

Refusal read_declinations(const std::vector<std::string>& words, Declinations& declinations) {
  declinations = {};
  if (words.empty() || (words.size() == 1 && words[0] == "-")) return std::nullopt;
  if (words.size() == 1) return "a declination has a value and a unit";
  const auto unit = angle_unit(words.back());
  if (!unit || unit->percent) return "is no unit of a declination: " + quoted(words.back());
  const auto degrees_at = [&](std::size_t i) -> std::optional<double> {
    const auto number = degrees_of(words[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    return *number * unit->degrees;
  };
  if (words.size() == 2) {
    declinations.undated = degrees_at(0);
    if (!declinations.undated) return "is no declination: " + quoted(words[0]);
    return std::nullopt;
  }
  if (words.size() % 2 == 0) return "a list of declinations has a date before each, and a unit at its end";
  for (std::size_t i = 0; i + 2 < words.size(); i += 2) {
    const auto value = degrees_at(i + 1);
    if (!value) return "is no declination: " + quoted(words[i + 1]);
    if (words[i] == "-") {
      declinations.undated = value;
      continue;
    }
    const auto years = years_of({words[i]}, 0);
    if (!years) return "is no date: " + quoted(words[i]);
    declinations.by_year.table.emplace_back(years->begin, *value);
  }
  std::sort(declinations.by_year.table.begin(), declinations.by_year.table.end());
  return std::nullopt;
}

}  // namespace karst::survey
