#include "sdk/survey/georeference.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core_stack/common/format_text.h"
#include "core_stack/common/output_file.h"
#include "core_stack/common/printable.h"
#include "core_stack/common/temporary_folder.h"
#include "sdk/survey/cavern.h"
#include "sdk/survey/dump3d.h"

namespace karst::survey {
namespace {

constexpr double kProbe_m =
    1e5;  // a leg whose end tells the turn: to 1e-7 rad, as positions are rounded to 1 cm

/// Survex's name of a coordinate system of Therion; none if it cannot be one.
std::optional<std::string> survex_system(const std::string& system) {
  if (system.empty() || system.size() > 64) return std::nullopt;
  for (const char c : system)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != ':' && c != '-') return std::nullopt;
  if (system == "lat-long" || system == "long-lat") return "long-lat";
  if (system.starts_with("UTM") && std::isdigit(static_cast<unsigned char>(system.back())))
    return system + "N";
  return system;
}

/// x and y in the order east, north.
std::pair<double, double> level_of(const Fix& fix) {
  return fix.system == "lat-long" ? std::pair(fix.y, fix.x) : std::pair(fix.x, fix.y);
}

std::string plane_of(const Fix& fix) {
  // Its axes point west and south: cavern writes the system that has them turned round.
  if (fix.system == "JTSK" || fix.system == "JTSK03") return "i" + fix.system;
  if (fix.system != "lat-long" && fix.system != "long-lat") return *survex_system(fix.system);
  const auto [longitude, latitude] = level_of(fix);
  const int zone = std::clamp(static_cast<int>(std::floor((longitude + 180) / 6)) + 1, 1, 60);
  return "UTM" + std::to_string(zone) + (latitude < 0 ? "S" : "N");
}

/// Year, month and day of a year with a fraction.
std::string date_text(double year) {
  const int whole = static_cast<int>(std::floor(year));
  int day = static_cast<int>(std::floor((year - whole) * 365.25 + 1e-6));
  constexpr std::array kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  std::size_t month = 0;
  while (month < 11 && day >= kDays.at(month)) day -= kDays.at(month++);
  return core::format_text("%04d.%02zu.%02d", whole, month + 1, std::min(day, 30) + 1);
}

class Probe {
 public:
  Probe(Readings& readings, const Network& network) : readings_(readings), network_(network) {}

  Georeference run() {
    result_.system = plane_of(readings_.fixes[network_.fixes.front()]);
    ask({}, std::nullopt);
    core::Vec3 mean = core::Vec3::Zero();
    for (std::size_t i = 0; i < network_.fixes.size(); ++i) {
      result_.fixes_m.push_back(place_of_fix(i));
      mean += result_.fixes_m.back() / static_cast<double>(network_.fixes.size());
    }
    const std::vector<double> years = years_of_readings();
    check_years();
    ask(years, mean);
    const double convergence = turn("u");
    std::map<double, double> declination;
    for (std::size_t i = 0; i < years.size(); ++i)
      declination[years[i]] = turn("y" + std::to_string(i)) - convergence;
    for (const Conditions& c : readings_.conditions)
      result_.turn_deg.push_back(turn_of(c, convergence, declination));
    return std::move(result_);
  }

 private:
  /// Years whose declination is asked for: those of readings, and the first of all.
  std::vector<double> years_of_readings() {
    std::vector<double> years;
    bool undated = false;
    for (const Conditions& c : readings_.conditions) {
      if (c.years) first_year_ = std::min(first_year_.value_or(c.years->begin), c.years->begin);
      if (c.declination_deg) continue;
      if (c.years) years.push_back(c.years->middle());
      undated |= !c.years;
    }
    if (undated && first_year_) years.push_back(*first_year_);
    std::sort(years.begin(), years.end());
    years.erase(std::unique(years.begin(), years.end()), years.end());
    return years;
  }

  /// cavern only warns of a year that it does not know, and takes the declination as zero.
  void check_years() const {
    constexpr double kFirst = 1900, kLast = 2079;  // of cavern: before this
    for (const Reading& r : readings_.legs) {
      const Conditions& c = readings_.conditions[r.conditions];
      const auto year = c.years ? std::optional(c.years->middle()) : first_year_;
      if (c.declination_deg || !year || (*year >= kFirst && *year < kLast)) continue;
      throw readings_.log.error(r.source,
                                core::format_text("the reference field is not known in %.0f: give a "
                                                  "declination, or correct the date",
                                                  std::floor(*year)));
    }
  }

  double turn_of(const Conditions& c, double convergence, const std::map<double, double>& declination) {
    if (c.declination_deg) return *c.declination_deg + (c.declination_from_grid ? 0 : convergence);
    if (c.years) return convergence + declination.at(c.years->middle());
    if (!told_) {
      told_ = true;
      readings_.log.note(
          {0, 0}, first_year_ ? "readings without a date have the declination of " + date_text(*first_year_)
                              : "no reading has a date or a declination: bearings are taken as true");
    }
    return convergence + (first_year_ ? declination.at(*first_year_) : 0);
  }

  /// Has cavern place the fixes, and legs due north of the compass in each of the years.
  void ask(const std::vector<double>& years, const std::optional<core::Vec3>& at) {
    const core::TemporaryFolder folder("survey");
    const std::string file = (folder.path() / "probe.svx").string();
    std::vector<Line> lines;
    write(file, years, at, lines);
    const std::string& root = readings_.log.files.front();
    const CavernRun run = run_cavern(file, folder.path(), root);
    for (const CavernMessage& m : run.messages) take(m, lines, at.has_value());
    if (!run.closed) throw core::InputError(root, "", "cavern could not place its fixed stations");
    places_.clear();
    const auto printed = run_dump3d(run.three_d.string(), folder.path(), root);
    for (const Dump3d::Node& node : read_dump3d(printed, root).nodes) places_[node.name] = node.position_m;
  }

  /// A line of what cavern is asked, and what of the survey it stands for.
  struct Line {
    const Fix* fix = nullptr;
    std::optional<double> year;
    bool undated = false;  // on purpose
  };

  /// What the first question has cavern say, the second one has it say again.
  void take(const CavernMessage& m, const std::vector<Line>& lines, bool is_second) {
    const std::size_t line = m.line == 0 ? 0 : m.line - 1;
    const Line of = line < lines.size() ? lines[line] : Line{};
    if (m.error) refuse(m, of.fix);
    if (is_second && !of.undated)
      readings_.log.note(source_of(m.line == 0 ? Line{} : of), "cavern: " + m.text);
  }

  [[noreturn]] void refuse(const CavernMessage& m, const Fix* fix) const {
    if (fix == nullptr)
      throw core::InputError(readings_.log.files.front(), "",
                             "its coordinates cannot be converted: " + m.text);
    throw readings_.log.error(fix->source,
                              "the coordinates in " + fix->system + " cannot be converted: " + m.text);
  }

  /// The fix, or the first reading of the year.
  Source source_of(const Line& line) const {
    if (line.fix != nullptr) return line.fix->source;
    for (const Reading& r : readings_.legs)
      if (const auto& years = readings_.conditions[r.conditions].years;
          line.year && years && years->middle() == *line.year)
        return r.source;
    return {0, 0};
  }

  void write(const std::string& file, const std::vector<double>& years, const std::optional<core::Vec3>& at,
             std::vector<Line>& lines) const {
    std::ofstream out = core::open_output(file);
    Line of_next;
    const auto line = [&](const std::string& text) {
      out << text << '\n';
      lines.push_back(of_next);
    };
    of_next.fix = &readings_.fixes[network_.fixes.front()];
    line("*cs out " + result_.system);
    for (std::size_t i = 0; i < network_.fixes.size(); ++i) {
      const Fix& fix = readings_.fixes[network_.fixes[i]];
      of_next.fix = &fix;
      const auto [x, y] = level_of(fix);
      line("*cs " + *survex_system(fix.system));
      line(core::format_text("*fix f%zu %.9f %.9f %.4f", i, x, y, fix.z));
    }
    of_next.fix = nullptr;
    line("*cs " + result_.system);
    // Used stations only are placed.
    line("*data nosurvey from to");
    for (std::size_t i = 1; i < network_.fixes.size(); ++i) line(core::format_text("f%zu f0", i));
    line("*data cartesian from to easting northing altitude");
    line("f0 f 1 1 1");
    if (!at) return;
    // At sea level, as Therion asks for it: two kilometres up the declination differs by 0.005 degrees.
    line(core::format_text("*declination auto %.3f %.3f 0", at->x(), at->y()));
    line("*data normal from to tape compass clino");
    of_next.undated = true;
    line(core::format_text("f0 u %.0f 0 0", kProbe_m));
    of_next.undated = false;
    for (std::size_t i = 0; i < years.size(); ++i) {
      of_next.year = years[i];
      line("*date " + date_text(years[i]));
      line(core::format_text("f0 y%zu %.0f 0 0", i, kProbe_m));
    }
  }

  core::Vec3 place_of_fix(std::size_t i) const {
    const auto it = places_.find("f" + std::to_string(i));
    if (it == places_.end())
      throw readings_.log.error(readings_.fixes[network_.fixes[i]].source,
                                "cavern did not place the fixed station");
    return it->second;
  }
  double turn(const std::string& station) const {
    const auto it = places_.find(station);
    if (it == places_.end())
      throw core::InputError(readings_.log.files.front(), "", "cavern gave no declination");
    const core::Vec3 leg = it->second - place_of_fix(0);
    return std::atan2(leg.x(), leg.y()) * 180 / std::numbers::pi;
  }

  Readings& readings_;
  const Network& network_;
  Georeference result_;
  std::map<std::string, core::Vec3> places_;
  std::optional<double> first_year_;
  bool told_ = false;
};

}  // namespace

Georeference georeference(Readings& readings, const Network& network) {
  const Fix* located = nullptr;
  const Fix* local = nullptr;
  for (const std::uint32_t i : network.fixes) {
    const Fix& fix = readings.fixes[i];
    (fix.system.empty() ? local : located) = &fix;
    if (!fix.system.empty() && !survex_system(fix.system))
      throw readings.log.error(fix.source, "is no coordinate system: " + core::printable(fix.system));
  }
  if (located != nullptr && local != nullptr)
    throw readings.log.error(local->source,
                             "is fixed in local coordinates, other stations in " + located->system);
  if (located != nullptr) return Probe(readings, network).run();
  Georeference result;
  for (const std::uint32_t i : network.fixes)
    result.fixes_m.emplace_back(readings.fixes[i].x, readings.fixes[i].y, readings.fixes[i].z);
  bool declined = false;
  for (const Conditions& c : readings.conditions) {
    result.turn_deg.push_back(c.declination_deg.value_or(0));
    declined |= c.declination_deg.has_value();
  }
  if (!declined)
    readings.log.note({0, 0}, "neither a declination nor a coordinate system: bearings are taken as true");
  return result;
}

}  // namespace karst::survey
