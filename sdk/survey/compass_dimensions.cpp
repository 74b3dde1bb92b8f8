#include "sdk/survey/compass_dimensions.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <unordered_map>

#include "core_stack/common/input_file.h"
#include "core_stack/common/printable.h"
#include "sdk/survey/input_path.h"
#include "sdk/survey/leg_lookup.h"
#include "sdk/survey/lower_case.h"
#include "sdk/survey/therion_units.h"

namespace karst::survey {
namespace {

constexpr double kFootLength_m = 0.3048;
constexpr double kMissing_ft = 990;  // from here on, and below zero, a distance was not measured
constexpr std::size_t kFirstDistance = 5;

std::uint32_t number_of_file(const std::string& file, SourceLog& log) {
  const auto known = std::find(log.files.begin(), log.files.end(), file);
  if (known == log.files.end()) log.files.push_back(file);
  return static_cast<std::uint32_t>(std::find(log.files.begin(), log.files.end(), file) - log.files.begin());
}

std::optional<double> distance_m(const std::string& word) {
  const auto feet = number_of(word);
  if (!feet || !std::isfinite(*feet) || *feet < 0 || *feet >= kMissing_ft) return std::nullopt;
  return *feet * kFootLength_m;
}

/// Whether "FORMAT: DDDDLRUDLADNT" puts the distances at the second station.
bool at_second_station(const std::string& line) {
  const std::size_t at = line.find("FORMAT:");
  if (at == std::string::npos) return false;
  std::string format;
  std::istringstream(line.substr(at + 7)) >> format;
  return format.size() >= 13 && format.back() == 'T';
}

void read_dat(const std::string& file, SourceLog& log, std::vector<CompassDimensions>& all) {
  std::istringstream lines(core::read_input(file, 1024 * core::kMiB));
  Source source{number_of_file(file, log), 0};
  std::uint32_t series = all.empty() ? 1 : all.back().series + 1;
  bool at_end = false, in_rows = false;
  for (std::string line; std::getline(lines, line);) {
    ++source.line;
    if (line.find('\f') != std::string::npos) {
      ++series;
      in_rows = at_end = false;
      continue;
    }
    if (line.find("FORMAT:") != std::string::npos) at_end = at_second_station(line);
    std::istringstream row(line);
    std::vector<std::string> words;
    for (std::string word; words.size() < kFirstDistance + 4 && row >> word;) words.push_back(word);
    if (words.size() < kFirstDistance + 4) continue;
    if (words[0] == "FROM" && words[1] == "TO") in_rows = true;
    if (!in_rows || !number_of(words[2])) continue;
    Dimensions d;
    d.left_m = distance_m(words[kFirstDistance]);
    d.up_m = distance_m(words[kFirstDistance + 1]);
    d.down_m = distance_m(words[kFirstDistance + 2]);
    d.right_m = distance_m(words[kFirstDistance + 3]);
    if (d.any()) all.push_back({words[0], words[1], at_end, d, series, source});
  }
}

}  // namespace

std::vector<CompassDimensions> read_compass_dimensions(const std::string& file, SourceLog& log) {
  std::vector<CompassDimensions> all;
  const std::filesystem::path path = file;
  if (ending_of(path) != ".mak") {
    read_dat(file, log, all);
    return all;
  }
  std::istringstream lines(core::read_input(file, core::kMaxTextFileBytes));
  Source source{number_of_file(file, log), 0};
  for (std::string line; std::getline(lines, line);) {
    ++source.line;
    if (!line.starts_with('#')) continue;
    const std::string name = line.substr(1, line.find_first_of(",;\r") - 1);
    const InputPath found = input_path(path.parent_path(), name);
    if (found.path.extension() == ".th" || found.path.extension() == ".th2" || found.path.empty())
      log.note(source, "cannot find " + core::printable(name) + ": without its left, right, up and down");
    else
      read_dat(found.path.string(), log, all);
  }
  return all;
}

void add_compass_sections(const std::vector<CompassDimensions>& dimensions, Survey& survey) {
  std::unordered_map<std::string, std::uint32_t> by_name;
  for (std::uint32_t i = 0; i < survey.stations.size(); ++i) {
    by_name.emplace(survey.stations[i].name, i);
    for (const std::string& alias : survey.stations[i].aliases) by_name.emplace(alias, i);
  }
  if (!dimensions.empty())  // the runs of legs without dimensions come behind those of the surveys
    for (Leg& l : survey.legs) l.run += dimensions.back().series;
  const LegLookup legs(survey);
  core::Vec3 facing = core::Vec3::UnitY();
  for (const CompassDimensions& d : dimensions) {
    const auto from = by_name.find(d.from), to = by_name.find(d.to);
    if (from == by_name.end() || to == by_name.end()) continue;
    const core::Vec3 leg = survey.stations[to->second].position_m - survey.stations[from->second].position_m;
    const core::Vec3 level(leg.x(), leg.y(), 0);
    if (level.norm() > 0.1 * leg.norm() && level.norm() > 1e-6) facing = level.normalized();
    Section& section = survey.sections.emplace_back();
    section.station = d.at_end ? to->second : from->second;
    section.facing = facing;
    section.dimensions = d.dimensions;
    section.run = d.series;
    section.leg = legs.between(from->second, to->second);
    if (section.leg) survey.legs[*section.leg].run = d.series;
    section.source = d.source;
  }
}

}  // namespace karst::survey
