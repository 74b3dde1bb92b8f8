// A survey written down in code, and the passages made of it.
#pragma once
#include <cstdint>
#include <stdexcept>

#include "sdk/survey_cave/passages.h"
#include "tests/unit/survey_cave/surveys.h"

namespace karst::test {

struct MadePassages {
  survey_cave::SurveyPart part;
  survey_cave::PassageGraph graph;
  survey_cave::Passages passages;

  const survey_cave::Tube& tube(std::uint32_t leg) const {
    for (const survey_cave::Tube& t : passages.tubes)
      if (t.leg() == leg) return t;
    throw std::out_of_range("no such tube");
  }
};

inline MadePassages passages_made(const survey::Survey& survey, double least_m = 0.1) {
  MadePassages made;
  made.part = survey_cave::part_of("cave.th", survey, {});
  made.graph = survey_cave::graph_of(survey, made.part, core::Vec3::Zero());
  made.passages = survey_cave::passages_of(survey, made.part, made.graph, core::Vec3::Zero(), least_m);
  return made;
}

}  // namespace karst::test
