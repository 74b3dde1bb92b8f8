#include "sdk/survey/survex_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/printable.h"
#include "core_stack/common/temporary_folder.h"
#include "sdk/survey/cavern.h"
#include "sdk/survey/compass_dimensions.h"
#include "sdk/survey/dump3d.h"
#include "sdk/survey/err_file.h"
#include "sdk/survey/facing.h"
#include "sdk/survey/include_cycle.h"
#include "sdk/survey/leg_lookup.h"
#include "sdk/survey/lower_case.h"
#include "sdk/survey/place_sets.h"
#include "sdk/survey/source_log.h"

namespace karst::survey {
namespace {

using Centimetres = std::array<long long, 3>;
struct HashOfCentimetres {
  std::size_t operator()(const Centimetres& c) const {
    std::size_t hash = 0;
    for (const long long part : c) hash = (hash ^ static_cast<std::size_t>(part)) * 0x9E3779B97F4A7C15u;
    return hash ^ (hash >> 29u);
  }
};
Centimetres centimetres(const core::Vec3& p) {
  return {std::llround(p.x() * 100), std::llround(p.y() * 100), std::llround(p.z() * 100)};
}

class FromDump {
 public:
  FromDump(const Dump3d& dump, Survey& survey) : dump_(dump), survey_(survey) {}

  void make() {
    survey_.title = dump_.title;
    find_walls();
    for (const Dump3d::Node& n : dump_.nodes)
      if (!n.name.empty() && (n.fixed || !walls_.contains(centimetres(n.position_m)))) add_station(n);
    for (const Dump3d::Line& l : dump_.lines) add_line(l);
    note_lost_legs();
    add_sections();
    join_runs();
    mark_surface();
    count_loops();
    set_facings(survey_);
  }

 private:
  /// Where splays alone lead. Such a place is no station, though it may have a name.
  void find_walls() {
    for (const Dump3d::Line& l : dump_.lines)
      if (l.splay) walls_.insert(centimetres(l.to_m));
    for (const Dump3d::Line& l : dump_.lines)
      for (const core::Vec3& end : {l.from_m, l.to_m})
        if (!l.splay) walls_.erase(centimetres(end));
  }

  void add_station(const Dump3d::Node& n) {
    const auto [it, is_new] =
        at_.try_emplace(centimetres(n.position_m), static_cast<std::uint32_t>(survey_.stations.size()));
    by_name_.emplace(n.name, it->second);
    if (is_new) {
      survey_.stations.emplace_back();
      survey_.stations.back().name = dotted(n.name);
      survey_.stations.back().position_m = n.position_m;
    } else {
      survey_.stations[it->second].aliases.push_back(dotted(n.name));
    }
    Station& station = survey_.stations[it->second];
    station.entrance |= n.entrance;
    station.fixed |= n.fixed;
  }

  /// With a dot between surveys, where the file has another separator: Compass has a space.
  std::string dotted(std::string name) const {
    std::replace(name.begin(), name.end(), dump_.separator, '.');
    return name;
  }

  std::optional<std::uint32_t> station_at(const core::Vec3& place) const {
    const auto it = at_.find(centimetres(place));
    return it == at_.end() ? std::nullopt : std::optional(it->second);
  }

  void add_line(const Dump3d::Line& l) {
    const auto from = station_at(l.from_m), to = station_at(l.to_m);
    // A splay leads to a point on the wall, with a name or without one.
    if (l.splay || !from || !to) {
      if (from && (!to || l.splay))
        survey_.splays.push_back({*from, l.to_m, l.surface, {}});
      else if (to)
        survey_.splays.push_back({*to, l.from_m, l.surface, {}});
      return;
    }
    if (*from == *to) {
      if (lost_legs_++ == 0) lost_at_ = *from;
      return;
    }
    Leg& leg = survey_.legs.emplace_back();
    leg.from = *from;
    leg.to = *to;
    leg.style = l.style.value_or(Style::normal);
    leg.surface = l.surface;
    leg.duplicate = l.duplicate;
    leg.run = l.run;
  }

  /// Stations are told apart by their places alone.
  void note_lost_legs() {
    if (lost_legs_ == 0) return;
    if (survey_.notes.size() >= kMaxNotes) {
      ++survey_.notes_left_out;
      return;
    }
    const Station& at = survey_.stations[lost_at_];
    std::string names = core::printable(at.name);
    for (std::size_t i = 0; i < at.aliases.size() && i < 2; ++i)
      names += " = " + core::printable(at.aliases[i]);
    survey_.notes.push_back(
        {{},
         core::counted(lost_legs_, "leg") +
             " left out: both ends round to the same centimetre, and are one station, such as " + names,
         0});
  }

  void add_sections() {
    for (const Dump3d::CrossSection& s : dump_.sections) {
      const auto station = by_name_.find(s.station);
      if (station == by_name_.end()) {
        survey_.notes.push_back(
            {{}, "a cross-section at an unknown station: " + core::printable(s.station), 0});
      } else {
        Section& section = survey_.sections.emplace_back();
        section.station = station->second;
        section.dimensions = s.dimensions;
        section.run = s.series;
      }
      if (survey_.notes.size() >= kMaxNotes) break;
    }
  }

  /// A .3d file does not say which legs a series of sections goes along: those between neighbouring sections
  /// are of its run. The runs of the other legs are numbered behind the series.
  void join_runs() {
    if (survey_.sections.empty()) return;
    for (Leg& l : survey_.legs) l.run += dump_.sections.back().series;
    const LegLookup legs(survey_);
    for (std::size_t i = 1; i < survey_.sections.size(); ++i) {
      const Section &a = survey_.sections[i - 1], &b = survey_.sections[i];
      if (a.run != b.run) continue;
      if (const auto leg = legs.between(a.station, b.station)) survey_.legs[*leg].run = b.run;
    }
  }

  void mark_surface() {
    std::vector<bool> surface(survey_.stations.size(), false), underground = surface;
    for (const Leg& l : survey_.legs)
      for (const std::uint32_t end : {l.from, l.to}) (l.surface ? surface : underground)[end] = true;
    for (std::size_t i = 0; i < survey_.stations.size(); ++i)
      survey_.stations[i].surface = surface[i] && !underground[i];
  }

  void count_loops() {
    PlaceSets parts(survey_.stations.size());
    for (const Leg& l : survey_.legs)
      if (l.style != Style::no_survey && !parts.unite(l.from, l.to)) ++survey_.loops.count;
    // Fixed stations count as one.
    std::optional<std::uint32_t> first;
    for (std::uint32_t i = 0; i < survey_.stations.size(); ++i) {
      if (!survey_.stations[i].fixed) continue;
      if (first && !parts.unite(*first, i)) ++survey_.loops.count;
      first = first.value_or(i);
    }
  }

  const Dump3d& dump_;
  Survey& survey_;
  std::unordered_set<Centimetres, HashOfCentimetres> walls_;
  std::unordered_map<Centimetres, std::uint32_t, HashOfCentimetres> at_;
  std::unordered_map<std::string, std::uint32_t> by_name_;
  std::size_t lost_legs_ = 0;
  std::uint32_t lost_at_ = 0;  // station of the first of them
};

/// cavern names stations of the parts that hang on no fixed one: one or more of each part.
std::string text_of_error(const CavernMessage& m) {
  if (m.unattached.empty()) return m.text;
  const std::size_t n = m.unattached.size();
  std::string text =
      m.text + ": " + (n == 1 ? "1 loose part, with" : "up to " + std::to_string(n) + " loose parts, with");
  for (std::size_t i = 0; i < n && i < 5; ++i) text += (i > 0 ? ", " : " ") + m.unattached[i];
  if (n > 5) text += " and others";
  return text +
         ". They are not attached to a fixed station: tie each by a leg or an *equate, or *fix one of its "
         "stations";
}

/// The first errors of cavern, each with its place.
[[noreturn]] void refuse_as_cavern(const std::string& file, const std::vector<CavernMessage>& messages) {
  constexpr std::size_t kMostErrors = 5;
  std::string in, place, text;
  std::size_t errors = 0;
  for (const CavernMessage& m : messages) {
    if (!m.error || ++errors > kMostErrors) continue;
    const std::string where = m.file.empty() ? file : m.file;
    const std::string line = m.line > 0 ? "line " + std::to_string(m.line) : "";
    if (errors == 1) {
      in = where;
      place = line;
      text = text_of_error(m);
    } else {
      text += "; " + (where == in ? "" : core::printable(where) + ": ") + (line.empty() ? "" : line + ": ") +
              text_of_error(m);
    }
  }
  if (errors > kMostErrors) text += "; and " + core::counted(errors - kMostErrors, "more error");
  throw core::InputError(in, place, text);
}

Survey from_processed(const std::string& three_d, const std::string& file,
                      const std::filesystem::path& folder, Survey survey) {
  const Dump3d dump = read_dump3d(run_dump3d(three_d, folder, file), file);
  FromDump(dump, survey).make();
  if (survey.legs.empty()) throw core::InputError(file, "", "holds no leg");
  return survey;
}

}  // namespace

Survey read_by_cavern(const std::string& file) {
  if (ending_of(file) == ".svx") refuse_include_cycles(file);
  const core::TemporaryFolder folder("survey");
  const CavernRun run = run_cavern(file, folder.path(), file);
  SourceLog log;
  log.files.push_back(file);
  for (const CavernMessage& m : run.messages) {
    const std::string& in = m.file.empty() ? file : m.file;
    if (m.error) refuse_as_cavern(file, run.messages);
    const auto known = std::find(log.files.begin(), log.files.end(), in);
    const auto number = static_cast<std::uint32_t>(known - log.files.begin());
    if (known == log.files.end()) log.files.push_back(in);
    log.note({number, static_cast<std::uint32_t>(m.line)}, "cavern: " + m.text);
  }
  if (!run.closed) throw core::InputError(file, "", "cavern could not process it");
  std::vector<CompassDimensions> dimensions;
  if (ending_of(file) != ".svx") dimensions = read_compass_dimensions(file, log);
  Survey survey;
  survey.files = log.files;
  survey.notes = log.notes;
  survey.notes_left_out = log.notes_left_out;
  survey = from_processed(run.three_d.string(), file, folder.path(), std::move(survey));
  survey.loops.traverses = read_err_file(run.err);
  add_compass_sections(dimensions, survey);
  return survey;
}

Survey read_processed(const std::string& file) {
  const core::TemporaryFolder folder("survey");
  Survey survey;
  survey.files.push_back(file);
  return from_processed(file, file, folder.path(), std::move(survey));
}

}  // namespace karst::survey
