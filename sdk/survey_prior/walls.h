// How far the walls are from the ends of legs, as a survey tells it.
#pragma once
#include <cstdint>
#include <vector>

#include "core_stack/mapping/prior/surveyed_passages.h"
#include "sdk/survey/survey.h"

namespace karst::survey_prior {

class Walls {
 public:
  /// `survey` must outlive it.
  explicit Walls(const survey::Survey& survey);

  /// At a station of the leg, seen along the leg from its first station to its second.
  core::PassageSize at(const survey::Leg& leg, std::uint32_t station) const;

 private:
  const survey::Survey& survey_;
  std::vector<std::vector<std::uint32_t>> sections_, splays_;  // by station: indices into the survey's
};

}  // namespace karst::survey_prior
