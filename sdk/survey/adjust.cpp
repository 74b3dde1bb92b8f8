#include "sdk/survey/adjust.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core_stack/common/printable.h"
#include "core_stack/common/temporary_folder.h"
#include "sdk/survey/cavern.h"
#include "sdk/survey/check_legs.h"
#include "sdk/survey/dump3d.h"
#include "sdk/survey/err_file.h"
#include "sdk/survey/facing.h"
#include "sdk/survey/georeference.h"
#include "sdk/survey/network.h"
#include "sdk/survey/survex_file.h"

namespace karst::survey {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

class Adjustment {
 public:
  explicit Adjustment(Readings readings) : readings_(std::move(readings)) {}

  Survey run() {
    network_ = network_of(readings_);
    const Georeference reference = georeference(readings_, network_);
    for (Reading& r : readings_.legs) turn(r, reference.turn_deg.at(r.conditions));
    close(reference.fixes_m);
    add_stations();
    check_legs(readings_, network_, positions_);
    add_legs();
    add_splays();
    add_sections();
    set_facings(survey_);
    survey_.title = readings_.title;
    survey_.left_out = network_.left_out;
    survey_.files = std::move(readings_.log.files);
    survey_.notes = std::move(readings_.log.notes);
    survey_.notes_left_out = readings_.log.notes_left_out;
    return std::move(survey_);
  }

 private:
  static void turn(Reading& r, double degrees) {
    if (r.style == Style::cartesian) {
      const double sine = std::sin(degrees * kDegree), cosine = std::cos(degrees * kDegree);
      const double east = r.east_m, north = r.north_m;
      r.east_m = cosine * east + sine * north;
      r.north_m = cosine * north - sine * east;
    }
    r.bearing_deg = std::fmod(std::fmod(r.bearing_deg + degrees, 360) + 360, 360);
  }

  void close(const std::vector<core::Vec3>& fixes_m) {
    const core::TemporaryFolder folder("survey");
    const std::string file = (folder.path() / "readings.svx").string();
    const std::vector<Source> sources = write_survex(file, readings_, network_, fixes_m);
    const CavernRun run = run_cavern(file, folder.path(), readings_.log.files.front());
    for (const CavernMessage& m : run.messages) take(m, sources);
    const std::string& root = readings_.log.files.front();
    if (!run.closed) throw core::InputError(root, "", "cavern could not close its loops");
    positions_.assign(network_.stations.size(), core::Vec3::Constant(kNotRead));
    for (const Dump3d::Node& node :
         read_dump3d(run_dump3d(run.three_d.string(), folder.path(), root), root).nodes)
      if (const auto place = place_of_name(node.name); place && *place < positions_.size())
        positions_[*place] = node.position_m;
    survey_.loops.count = network_.loops;
    survey_.loops.traverses = read_err_file(run.err);
    for (Loops::Traverse& t : survey_.loops.traverses) {
      name(t.from);
      name(t.to);
      for (std::string& station : t.stations) name(station);
    }
  }

  /// The survey's own name of what was written for cavern.
  void name(std::string& station) const {
    if (const auto place = place_of_name(station); place && *place < network_.stations.size())
      station = readings_.stations[network_.stations[*place]].name;
  }

  void take(const CavernMessage& m, const std::vector<Source>& sources) {
    const bool placed = m.line > 0 && m.line <= sources.size();
    const Source source = placed ? sources[m.line - 1] : Source{};
    if (m.error) throw readings_.log.error(source, "cavern refuses it: " + m.text);
    readings_.log.note(source, "cavern: " + m.text);
  }

  void add_stations() {
    survey_.stations.resize(network_.stations.size());
    for (std::uint32_t s = 0; s < readings_.stations.size(); ++s) {
      const std::uint32_t place = network_.place[s];
      if (place == Network::kNone || readings_.stations[s].anonymous) continue;
      const ReadStation& read = readings_.stations[s];
      Station& station = survey_.stations[place];
      if (station.name.empty()) {
        station.name = read.name;
        station.source = read.source;
        station.position_m = positions_[place];
      } else {
        station.aliases.push_back(read.name);
      }
      if (station.comment.empty()) station.comment = read.comment;
      station.entrance |= read.entrance;
      station.continuation |= read.continuation;
    }
    for (const std::uint32_t i : network_.fixes)
      survey_.stations[network_.place[readings_.fixes[i].station]].fixed = true;
    if (network_.fixes.empty()) survey_.stations.front().fixed = true;
    for (std::size_t i = 0; i < survey_.stations.size(); ++i)
      if (!survey_.stations[i].position_m.allFinite())
        throw readings_.log.error(readings_.stations[network_.stations[i]].source,
                                  "cavern gave no position of " + core::printable(survey_.stations[i].name));
  }

  void add_legs() {
    std::vector<bool> underground(survey_.stations.size(), false), reached(survey_.stations.size(), false);
    leg_of_.assign(readings_.legs.size(), Network::kNone);
    for (const std::uint32_t i : network_.legs) {
      const Reading& r = readings_.legs[i];
      leg_of_[i] = static_cast<std::uint32_t>(survey_.legs.size());
      Leg& leg = survey_.legs.emplace_back();
      leg.from = network_.place[r.from];
      leg.to = network_.place[r.to];
      leg.style = r.style;
      leg.surface = r.surface;
      leg.duplicate = r.duplicate;
      leg.approximate = r.approximate;
      leg.extend = r.extend;
      leg.run = r.run;
      leg.source = r.source;
      measured(r, leg);
      for (const std::uint32_t end : {leg.from, leg.to}) {
        reached[end] = true;
        if (!r.surface) underground[end] = true;
      }
    }
    for (std::size_t i = 0; i < survey_.stations.size(); ++i)
      survey_.stations[i].surface = reached[i] && !underground[i];
  }

  static void measured(const Reading& r, Leg& leg) {
    if (r.style == Style::no_survey) return;
    const core::Vec3 vector = r.vector_m();
    const bool by_compass = r.style != Style::cartesian;
    leg.length_m = by_compass && r.style != Style::cylpolar ? r.length_m : vector.norm();
    const double bearing = by_compass ? r.bearing_deg * kDegree : std::atan2(vector.x(), vector.y());
    if (!r.plumbed && !std::isnan(bearing))
      leg.bearing_rad = std::fmod(bearing + 2 * std::numbers::pi, 2 * std::numbers::pi);
    leg.inclination_rad = std::isnan(r.inclination_deg) ? std::atan2(vector.z(), vector.head<2>().norm())
                                                        : r.inclination_deg * kDegree;
  }

  void add_splays() {
    for (const Network::SplayAt& s : network_.splays) {
      const Reading& r = readings_.legs[s.reading];
      const core::Vec3 vector = r.vector_m();
      const core::Vec3 end = positions_[s.place] + (s.reversed ? core::Vec3(-vector) : vector);
      survey_.splays.push_back({s.place, end, r.surface, r.source});
    }
  }

  void add_sections() {
    for (const ReadDimensions& d : readings_.dimensions) {
      if (leg_of_[d.leg] == Network::kNone) continue;
      const Leg& leg = survey_.legs[leg_of_[d.leg]];
      add_section({d.at_end ? leg.to : leg.from, leg_of_[d.leg], core::Vec3::UnitY(), d.dimensions, leg.run,
                   d.source});
    }
    add_station_sections();
  }

  /// One of a run's station that the leg before noted as well is the same section.
  void add_section(const Section& section) {
    if (!survey_.sections.empty()) {
      Section& last = survey_.sections.back();
      if (last.run == section.run && last.station == section.station)
        return merge(section.dimensions, last.dimensions);
    }
    survey_.sections.push_back(section);
  }

  static void merge(const Dimensions& more, Dimensions& d) {
    if (!d.left_m) d.left_m = more.left_m;
    if (!d.right_m) d.right_m = more.right_m;
    if (!d.up_m) d.up_m = more.up_m;
    if (!d.down_m) d.down_m = more.down_m;
  }

  /// Dimensions that were noted for a station belong to the first leg that ends there, else begins there.
  void add_station_sections() {
    if (readings_.station_dimensions.empty()) return;
    std::vector<std::uint32_t> ends(survey_.stations.size(), Network::kNone), begins = ends;
    for (std::size_t i = survey_.legs.size(); i-- > 0;) {
      ends[survey_.legs[i].to] = static_cast<std::uint32_t>(i);
      begins[survey_.legs[i].from] = static_cast<std::uint32_t>(i);
    }
    for (const StationDimensions& d : readings_.station_dimensions) {
      const std::uint32_t station = network_.place[d.station];
      if (station == Network::kNone) continue;
      const std::uint32_t leg = ends[station] != Network::kNone ? ends[station] : begins[station];
      if (leg == Network::kNone) continue;
      survey_.sections.push_back(
          {station, leg, core::Vec3::UnitY(), d.dimensions, survey_.legs[leg].run, d.source});
    }
    const auto order = [&](const Section& s) {
      return std::pair(*s.leg, s.station == survey_.legs[*s.leg].to);
    };
    std::stable_sort(survey_.sections.begin(), survey_.sections.end(),
                     [&](const Section& a, const Section& b) { return order(a) < order(b); });
    std::vector<Section> sorted = std::exchange(survey_.sections, {});
    for (const Section& s : sorted) add_section(s);
  }

  Readings readings_;
  Network network_;
  std::vector<core::Vec3> positions_;  // of places
  std::vector<std::uint32_t> leg_of_;  // of each reading; Network::kNone: no leg
  Survey survey_;
};

}  // namespace

Survey adjusted(Readings readings) { return Adjustment(std::move(readings)).run(); }

}  // namespace karst::survey
