#include "sdk/survey/therion_centreline.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/printable.h"
#include "sdk/survey/therion_files.h"

namespace karst::survey {
namespace {

constexpr std::size_t kMaxGroups = 256;  // in each other

std::string quoted_name(const std::string& word) { return "'" + core::printable(word) + "'"; }

bool counts_from_latitude(const std::string& system) { return system == "lat-long"; }
bool is_geographic(const std::string& system) { return counts_from_latitude(system) || system == "long-lat"; }

/// Flags of a station that are followed by a word, and how many.
std::size_t words_behind(const std::string& flag, bool on) {
  if (flag == "explored") return on ? 1 : 0;
  if (flag == "attr") return on ? 2 : 1;
  return 0;
}

bool is_other_flag(const std::string& flag) {
  constexpr auto kFlags = std::to_array<std::string_view>(
      {"air-draught", "air-draught:summer", "air-draught:winter", "arch", "attr", "code", "dig", "doline",
       "explored", "overhang", "sink", "spring"});
  return std::find(kFlags.begin(), kFlags.end(), flag) != kFlags.end();
}

}  // namespace

void Centreline::refuse(const std::string& reason) const { throw readings_.log.error(source_, reason); }
void Centreline::apply(const Refusal& refusal) const {
  if (refusal) refuse(*refusal);
}

std::uint32_t Centreline::number_of_station(const std::string& word, std::uint32_t survey,
                                            bool defines) const {
  const auto name = groups_.back().settings.station_name(word);
  if (!name) refuse("is no name of a station: " + quoted_name(word));
  return names_.number(survey, *name, source_, defines);
}

void Centreline::begin(std::uint32_t survey, const Declinations& outer, const Source& source) {
  groups_.assign(1, {});
  rows_.begin({});
  rows_.new_conditions();
  declinations_ = outer;
  years_.reset();
  first_conditions_ = readings_.conditions.size();
  survey_ = survey;
  began_ = source_ = source;
}

void Centreline::end() {
  if (groups_.size() > 1) refuse("a group has no endgroup");
  rows_.interrupt();
  groups_.assign(1, {});
  for (std::size_t i = first_conditions_; i < readings_.conditions.size(); ++i) {
    Conditions& c = readings_.conditions[i];
    c.years = years_;
    if (!c.declination_deg && declinations_.any()) c.declination_deg = declinations_.at(years_);
  }
}

bool Centreline::line(const std::vector<std::string>& words, const Source& source) {
  source_ = source;
  if (words.front() == "endcentreline" || words.front() == "endcenterline") {
    end();
    return false;
  }
  if (command(words)) return true;
  if (words.front() == "!") {  // a row whose first word could be a command
    rows_.row({words.begin() + 1, words.end()}, source, survey_, groups_.back().settings);
    return true;
  }
  rows_.row(words, source, survey_, groups_.back().settings);
  return true;
}

bool Centreline::command(const std::vector<std::string>& words) {
  const std::string& name = words.front();
  Settings& settings = groups_.back().settings;
  if (name == "data") {
    data(words);
  } else if (name == "units") {
    if (words.size() == 3 && quantities_of(words[1]).empty() && metres_of_unit(words[2]))
      readings_.log.note(source_,
                         "units of " + core::printable(words[1]) + ", which is no quantity: left out");
    else
      apply(set_units(words, settings));
  } else if (name == "calibrate") {
    apply(set_calibration(words, settings));
  } else if (name == "sd") {
    apply(set_deviation(words, settings));
  } else if (name == "flags") {
    apply(set_flags(words, settings));
  } else if (name == "infer") {
    apply(set_infer(words, settings));
  } else if (name == "declination" || name == "grid-angle") {
    declination(words);
  } else if (name == "date") {
    date(words);
  } else if (name == "equate") {
    equate(words, source_, survey_);
  } else if (name == "fix") {
    fix(words);
  } else if (name == "station") {
    station(words);
  } else if (name == "extend") {
    extend(words);
  } else if (name == "cs") {
    if (words.size() != 2) refuse("cs takes the name of one coordinate system");
    settings.system = words[1] == "local" ? "" : words[1];
  } else if (name == "station-names") {
    if (words.size() != 3) refuse("station-names takes a prefix and a suffix");
    settings.name_prefix = words[1];
    settings.name_suffix = words[2];
  } else if (name == "break") {
    rows_.interrupt();
  } else if (name == "group") {
    group();
  } else if (name == "endgroup") {
    end_group();
  } else if (name == "grade") {
    readings_.log.note(source_, "grades are not read: Survex's standard deviations hold");
  } else {
    return is_remark(name);
  }
  return true;
}

void Centreline::data(const std::vector<std::string>& words) {
  apply(read_format(words, groups_.back().format));
  rows_.begin(groups_.back().format);
}

void Centreline::declination(const std::vector<std::string>& words) {
  std::vector<std::string> list(words.begin() + 1, words.end());
  if (list.size() == 1) split_words(words[1], list);
  Declinations read;
  apply(read_declinations(list, read));
  Conditions& conditions = groups_.back().settings.conditions;
  conditions.declination_from_grid = words.front() == "grid-angle" && read.any();
  conditions.declination_deg.reset();
  if (!read.by_year.table.empty())
    declinations_ = read;  // by the date of the centreline, which may stand below
  else
    conditions.declination_deg = read.undated;
}

void Centreline::date(const std::vector<std::string>& words) {
  if (words.size() == 2 && words[1] == "-") return;
  const auto years = years_of(words, 1);
  if (!years) refuse("is no date: " + quoted_name(words.size() > 1 ? words[1] : ""));
  years_ =
      years_ ? YearRange{std::min(years_->begin, years->begin), std::max(years_->end, years->end)} : *years;
}

void Centreline::equate(const std::vector<std::string>& words, const Source& source, std::uint32_t survey) {
  source_ = source;
  if (words.size() < 3) refuse("equate takes two stations or more");
  const std::uint32_t first = number_of_station(words[1], survey, false);
  for (std::size_t i = 2; i < words.size(); ++i)
    readings_.equates.push_back({first, number_of_station(words[i], survey, false), source});
}

void Centreline::fix(const std::vector<std::string>& words) {
  if (words.size() < 5 || words.size() > 8)
    refuse("fix takes a station, three coordinates and standard deviations");
  const Settings& settings = groups_.back().settings;
  Fix fix;
  fix.system = settings.system;
  fix.source = source_;
  fix.station = number_of_station(words[1], survey_, true);
  const bool degrees = is_geographic(settings.system);
  std::vector<double> numbers;
  for (std::size_t i = 2; i < words.size(); ++i) {
    const auto number = degrees && i < 4 ? degrees_of(words[i]) : number_of(words[i]);
    if (!number || !std::isfinite(*number) || std::abs(*number) > 1e9)
      refuse("is no coordinate: " + quoted_name(words[i]));
    numbers.push_back(*number);
  }
  const bool local = settings.system.empty();
  fix.x = local ? settings.metres(Quantity::x, numbers[0]) : numbers[0];
  fix.y = local ? settings.metres(Quantity::y, numbers[1]) : numbers[1];
  fix.z = settings.metres(Quantity::z, numbers[2]);
  if (numbers.size() > 3) {
    for (std::size_t i = 3; i < numbers.size(); ++i)
      if (numbers[i] <= 0) refuse("a standard deviation must be positive: " + words[i + 2]);
    const double level = numbers[3], up = numbers.back();
    fix.sd_m = core::Vec3(level, numbers.size() == 6 ? numbers[4] : level, up);
  }
  readings_.fixes.push_back(fix);
}

void Centreline::station(const std::vector<std::string>& words) {
  if (words.size() < 3) refuse("station takes a name, a comment and flags");
  StationRemark remark;
  remark.source = source_;
  remark.station = number_of_station(words[1], survey_, false);
  remark.comment = words[2];
  bool on = true;
  for (std::size_t i = 3; i < words.size(); ++i) {
    const std::string& flag = words[i];
    if (flag == "not") {
      on = false;
      continue;
    }
    if (flag == "entrance")
      remark.entrance = on;
    else if (flag == "continuation")
      remark.continuation = on;
    else if (flag == "fixed" ? on : !is_other_flag(flag))
      refuse("is no flag of a station: " + quoted_name(flag));
    i += words_behind(flag, on);
    if (i >= words.size()) refuse("a word is missing behind " + quoted_name(flag));
    on = true;
  }
  if (!on) refuse("'not' is followed by a flag");
  remarks_.stations.push_back(std::move(remark));
}

void Centreline::extend(const std::vector<std::string>& words) {
  if (words.size() < 2) refuse("extend takes a direction");
  const auto direction = core::parse<Extend>(words[1]);
  if (!direction) {
    if (words[1] == "start" || number_of(words[1])) return;  // where a profile begins, or a scale of it
    refuse("is no direction of extend: " + quoted_name(words[1]));
  }
  if (words.size() == 2) groups_.back().settings.extend = *direction;
  if (words.size() == 4)
    remarks_.extends.push_back({number_of_station(words[2], survey_, false),
                                number_of_station(words[3], survey_, false), *direction});
}

void Centreline::group() {
  if (groups_.size() >= kMaxGroups) refuse("groups stand too deep in each other");
  groups_.push_back(groups_.back());
  rows_.interrupt();
}

void Centreline::end_group() {
  if (groups_.size() == 1) refuse("endgroup without group");
  groups_.pop_back();
  rows_.begin(groups_.back().format);
}

}  // namespace karst::survey
