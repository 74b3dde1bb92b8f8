#include "sdk/survey_export/svx_file.h"

#include <optional>

#include "core_stack/common/format_text.h"
#include "sdk/survey_export/leg_words.h"
#include "sdk/survey_export/new_legs.h"

namespace karst::survey_export {
namespace {

using core::format_text;

std::string survex_legs(const FlownSurvey& flown) {
  std::string text = "*data normal from to tape compass clino\n";
  std::optional<LegDeviations> last;
  for (std::size_t i = 0; i < flown.survey.legs.size(); ++i) {
    const survey::Leg& leg = flown.survey.legs[i];
    if (i > 0 && leg.run != flown.survey.legs[i - 1].run) text += '\n';
    if (const LegDeviations d = deviations_of(flown, i); d != last) {
      text += format_text("*sd tape %.2f metres\n*sd compass clino %.1f degrees\n", d.tape_m, d.angle_deg);
      last = d;
    }
    text += leg_words(flown, leg) + (leg.approximate ? " ; approximate: seen, not flown" : "") +
            (is_new(flown, i) ? " ; new\n" : "\n");
  }
  return text;
}

/// A list for each run: Survex draws a tube along it.
std::string passages(const FlownSurvey& flown) {
  std::string text;
  std::optional<std::uint32_t> run;
  for (const survey::Section& s : flown.survey.sections) {
    if (s.run != run) text += "\n*data passage station left right up down\n";
    run = s.run;
    text += section_words(flown, s) + '\n';
  }
  return text;
}

}  // namespace

std::string svx_text(const FlownSurvey& flown, const Placing& placing) {
  std::string text = "; " + title_words(flown.survey.title) + "\n; " + accuracy_words(flown.accuracy) + '\n';
  if (const std::string words = new_words(flown); !words.empty()) text += "; " + words + '\n';
  text += "*begin " + flown.name + '\n';
  text += "*title \"" + title_words(flown.survey.title) + "\"\n";
  if (!placing.system.empty()) text += "*cs " + placing.system + "\n*cs out " + placing.system + '\n';
  text += format_text("*declination %.4f degrees\n", placing.declination_deg);
  text += "*units tape left right up down metres\n*units compass clino degrees\n";
  for (std::uint32_t i = 0; i < flown.survey.stations.size(); ++i) {
    const survey::Station& s = flown.survey.stations[i];
    const std::string name = station_word(flown, i);
    if (s.fixed && placing.fixed) {
      const core::Vec3 p = placed(placing, flown, s.position_m);
      text += format_text("*fix %s %.3f %.3f %.3f\n", name.c_str(), p.x(), p.y(), p.z());
    }
    if (s.entrance) text += "*entrance " + name + '\n';
    if (s.continuation) text += "; station " + name + ": the passage goes on into unknown space\n";
  }
  return text + survex_legs(flown) + passages(flown) + "*end " + flown.name + '\n';
}

}  // namespace karst::survey_export
