#include "sdk/survey/survey.h"

namespace karst::survey {

std::string place_of(const Survey& survey, const Source& source) {
  const std::string file = source.file < survey.files.size() ? survey.files[source.file] : "";
  return source.line == 0 ? file : file + ": line " + std::to_string(source.line);
}

double length_m(const Survey& survey) {
  double sum = 0;
  for (const Leg& l : survey.legs)
    if (!l.surface && !l.duplicate && l.style != Style::no_survey)
      sum += (survey.stations[l.to].position_m - survey.stations[l.from].position_m).norm();
  return sum;
}

}  // namespace karst::survey
