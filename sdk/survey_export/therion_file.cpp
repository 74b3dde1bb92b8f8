#include "sdk/survey_export/therion_file.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core_stack/common/format_text.h"
#include "sdk/survey_export/leg_words.h"
#include "sdk/survey_export/new_legs.h"

namespace karst::survey_export {
namespace {

using core::format_text;

constexpr std::size_t kMostTies = 64;  // Therion weighs each vertex of the mesh with each of them

std::string therion_legs(const FlownSurvey& flown) {
  std::string text = "    data normal from to length compass clino\n";
  std::optional<LegDeviations> last;
  bool approximate = false;
  for (std::size_t i = 0; i < flown.survey.legs.size(); ++i) {
    const survey::Leg& leg = flown.survey.legs[i];
    if (const LegDeviations d = deviations_of(flown, i); d != last) {
      text += format_text(
          "    sd length %.2f metres\n    sd bearing %.1f degrees\n    sd gradient %.1f degrees\n", d.tape_m,
          d.angle_deg, d.angle_deg);
      last = d;
    }
    if (leg.approximate != approximate)
      text += leg.approximate ? "    flags approximate\n" : "    flags not approximate\n";
    approximate = leg.approximate;
    text += "      " + leg_words(flown, leg) + (is_new(flown, i) ? "  # new\n" : "\n");
  }
  return text + (approximate ? "    flags not approximate\n" : "");
}

/// One section for each station, that of the first run through it: Therion keeps one.
std::string dimensions(const FlownSurvey& flown) {
  std::string text = "    data dimensions station left right up down\n";
  std::vector<char> told(flown.survey.stations.size());
  for (const survey::Section& s : flown.survey.sections) {
    if (told[s.station] != 0 || !s.dimensions.any()) continue;
    told[s.station] = 1;
    text += "      " + section_words(flown, s) + '\n';
  }
  return text;
}

}  // namespace

std::string therion_text(const FlownSurvey& flown, const Placing& placing) {
  const std::string title = title_words(flown.survey.title);
  std::string text = "encoding utf-8\n# " + title + "\n# " + accuracy_words(flown.accuracy) + '\n';
  if (const std::string words = new_words(flown); !words.empty()) text += "# " + words + '\n';
  text += "survey " + flown.name + " -title \"" + title + "\"\n  centreline\n";
  if (!placing.system.empty()) text += "    cs " + placing.system + '\n';
  for (std::uint32_t i = 0; i < flown.survey.stations.size(); ++i)
    if (flown.survey.stations[i].fixed && placing.fixed) {
      const core::Vec3 p = placed(placing, flown, flown.survey.stations[i].position_m);
      text += format_text("    fix %s %.3f %.3f %.3f\n", station_word(flown, i).c_str(), p.x(), p.y(), p.z());
    }
  // Therion adds the convergence of the meridians to a declination, but not to a grid angle; it takes a grid
  // angle only with a coordinate system.
  text += format_text("    %s %.4f degrees\n", placing.system.empty() ? "declination" : "grid-angle",
                      placing.declination_deg);
  text += "    units length left right up down metres\n    units bearing gradient degrees\n";
  text += therion_legs(flown) + dimensions(flown);
  for (std::uint32_t i = 0; i < flown.survey.stations.size(); ++i) {
    const survey::Station& s = flown.survey.stations[i];
    if (!s.entrance && !s.continuation) continue;
    text += "    station " + station_word(flown, i) + " \"" + s.comment + '"' +
            (s.entrance ? " entrance" : "") + (s.continuation ? " continuation" : "") + '\n';
  }
  return text + "  endcentreline\nendsurvey\n";
}

std::string thconfig_text(const std::string& stem, const Placing& placing) {
  std::string text = "encoding utf-8\n# Therion 6.4 and later take the walls as well: read \"" + stem +
                     "_scan.th\" instead.\nsource \"" + stem + ".th\"\n";
  if (!placing.system.empty()) text += "cs " + placing.system + '\n';
  return text + "export model -fmt loch -o \"" + stem + ".lox\"\nexport model -fmt survex -o \"" + stem +
         "_therion.3d\"\n";
}

std::string scan_text(const FlownSurvey& flown, const std::string& stem) {
  std::string text =
      "encoding utf-8\n# Therion 6.4 and later. Stations with their places in the mesh.\ninput \"" + stem +
      ".th\"\nscan\n  file \"" + stem + ".stl\"\n  units metres\n";
  const std::size_t count = flown.survey.stations.size(), ties = std::min(count, kMostTies);
  for (std::size_t k = 0; k < ties; ++k) {
    const auto i = static_cast<std::uint32_t>(k * count / ties);
    const core::Vec3& p = flown.survey.stations[i].position_m;
    text += format_text("  %s@%s %.3f %.3f %.3f\n", station_word(flown, i).c_str(), flown.name.c_str(), p.x(),
                        p.y(), p.z());
  }
  return text + "endscan\n";
}

}  // namespace karst::survey_export
