#include "sdk/survey/therion_reader.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "core_stack/common/printable.h"
#include "sdk/survey/therion_centreline.h"
#include "sdk/survey/therion_files.h"

namespace karst::survey {
namespace {

/// Blocks without survey data, which end at end<NAME>.
bool is_skipped_block(const std::string& command) {
  constexpr auto kBlocks =
      std::to_array<std::string_view>({"scrap", "map", "surface", "grade", "layout", "lookup", "revise",
                                       "comment", "source", "area", "line"});
  return std::find(kBlocks.begin(), kBlocks.end(), command) != kBlocks.end();
}
bool is_skipped_line(const std::string& command) {
  constexpr auto kLines = std::to_array<std::string_view>(
      {"join", "scan", "select", "unselect", "export", "point", "cs", "title", "system", "maps",
       "maps-offset", "log", "language", "text", "input-encoding", "sketch-warp", "sketch-colors"});
  return std::find(kLines.begin(), kLines.end(), command) != kLines.end();
}

class TherionReader {
 public:
  explicit TherionReader(const std::string& file)
      : files_(file, readings_.log), centreline_(readings_, names_, remarks_) {}

  Readings read() {
    while (files_.next()) line();
    if (in_centreline_) throw error_at(centreline_.began(), "the centreline has no endcentreline");
    if (!skipping_.empty()) throw error_at(skip_began_, skipping_ + " has no end" + skipping_);
    if (surveys_.size() > 1) throw error_at(surveys_.back().source, "the survey has no endsurvey");
    finish();
    return std::move(readings_);
  }

 private:
  struct Level {
    std::uint32_t survey = 0;
    Declinations declinations;
    std::string name;
    Source source;
  };

  core::InputError error_at(const Source& source, const std::string& reason) const {
    return readings_.log.error(source, reason);
  }
  [[noreturn]] void refuse(const std::string& reason) const { throw error_at(files_.source(), reason); }

  void line() {
    const std::vector<std::string>& words = files_.words();
    const std::string& command = words.front();
    if (!skipping_.empty()) {
      if (command == "end" + skipping_) skipping_.clear();
    } else if (in_centreline_) {
      in_centreline_ = centreline_.line(words, files_.source());
    } else if (command == "survey") {
      begin_survey(words);
    } else if (command == "endsurvey") {
      end_survey(words);
    } else if (command == "centreline" || command == "centerline") {
      centreline_.begin(surveys_.back().survey, surveys_.back().declinations, files_.source());
      in_centreline_ = true;
    } else if (command == "equate") {
      centreline_.equate(words, files_.source(), surveys_.back().survey);
    } else if (command == "import") {
      readings_.log.note(files_.source(), "imports are not read");
    } else if (is_skipped_block(command)) {
      // `source FILE` is a line; without a file it is a block.
      if (command == "source" && words.size() > 1) return;
      skipping_ = command;
      skip_began_ = files_.source();
    } else if (!is_skipped_line(command)) {
      refuse("is no command: '" + core::printable(command) + "'");
    }
  }

  void begin_survey(const std::vector<std::string>& words) {
    if (words.size() < 2) refuse("survey takes a name");
    // With these in it, "a.b" and "1@a" could mean two things. Therion refuses them as well.
    if (words[1].empty() || words[1].find_first_of(".@") != std::string::npos)
      refuse("is no name of a survey: '" + core::printable(words[1]) + "'");
    if (surveys_.size() > kMaxSurveyDepth) refuse("surveys stand too deep in each other");
    Level level = surveys_.back();
    level.name = words[1];
    level.source = files_.source();
    bool has_names = true;
    std::string entrance;
    for (std::size_t i = 2; i + 1 < words.size(); ++i) {
      if (words[i] == "-title" && readings_.title.empty()) readings_.title = words[i + 1];
      if (words[i] == "-namespace") has_names = words[i + 1] != "off";
      if (words[i] == "-entrance") entrance = words[i + 1];
      if (words[i] == "-declination") {
        std::vector<std::string> list;
        split_words(words[i + 1], list);
        // Without brackets, value and unit are two words.
        if (list.size() == 1 && i + 2 < words.size() && angle_unit(words[i + 2]))
          list.push_back(words[i + 2]);
        if (const Refusal refusal = read_declinations(list, level.declinations)) refuse(*refusal);
      }
    }
    if (has_names) level.survey = tree_.enter(surveys_.back().survey, level.name);
    if (tree_.name_bytes(level.survey) > kMaxStationName) refuse("the names of the surveys are too long");
    surveys_.push_back(std::move(level));
    if (!entrance.empty())
      remarks_.stations.push_back({names_.number(surveys_.back().survey, entrance, files_.source(), false),
                                   "", true, false, files_.source()});
  }

  void end_survey(const std::vector<std::string>& words) {
    if (surveys_.size() == 1) refuse("endsurvey without survey");
    if (words.size() > 1 && words[1] != surveys_.back().name)
      refuse("endsurvey " + core::printable(words[1]) + " ends survey " + surveys_.back().name);
    surveys_.pop_back();
  }

  /// Numbers of names become those of stations.
  void finish() {
    const StationNames::Resolved resolved = names_.resolve(tree_, readings_.log);
    readings_.stations = resolved.stations;
    const auto station = [&](std::uint32_t& number) { number = resolved.number[number]; };
    for (Reading& r : readings_.legs) station(r.from), station(r.to);
    for (Fix& f : readings_.fixes) station(f.station);
    std::vector<bool> known = resolved.defined;
    for (Equate& e : readings_.equates) {
      station(e.a), station(e.b);
      for (const std::uint32_t s : {e.a, e.b})
        if (!known[s]) {
          known[s] = true;
          readings_.log.note(e.source, "no leg leads to " + core::printable(readings_.stations[s].name) +
                                           ", which is equated here");
        }
    }
    const auto known_station = [&](std::uint32_t& number, const Source& source) {
      station(number);
      if (!known[number])
        throw error_at(source, "there is no station " + core::printable(readings_.stations[number].name));
    };
    for (StationDimensions& d : readings_.station_dimensions) known_station(d.station, d.source);
    for (StationRemark& remark : remarks_.stations) {
      known_station(remark.station, remark.source);
      ReadStation& read = readings_.stations[remark.station];
      if (!remark.comment.empty()) read.comment = remark.comment;
      read.entrance |= remark.entrance;
      read.continuation |= remark.continuation;
    }
    set_extends(resolved.number);
  }

  void set_extends(const std::vector<std::uint32_t>& station) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Extend> of_legs;
    for (const ExtendOfLeg& e : remarks_.extends)
      of_legs[std::minmax(station[e.from], station[e.to])] = e.extend;
    if (of_legs.empty()) return;
    for (Reading& r : readings_.legs)
      if (const auto it = of_legs.find(std::minmax(r.from, r.to)); it != of_legs.end()) r.extend = it->second;
  }

  Readings readings_;
  TherionFiles files_;
  SurveyTree tree_;
  StationNames names_;
  TherionRemarks remarks_;
  Centreline centreline_;
  std::vector<Level> surveys_{1};
  bool in_centreline_ = false;
  std::string skipping_;
  Source skip_began_;
};

}  // namespace

Readings read_therion(const std::string& file) { return TherionReader(file).read(); }

}  // namespace karst::survey
