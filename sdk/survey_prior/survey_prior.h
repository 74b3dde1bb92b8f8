// What a survey tells of the cave before the flight, in the frame of the flight.
#pragma once
#include <string>

#include "core_stack/mapping/prior/surveyed_passages.h"
#include "sdk/survey/survey.h"

namespace karst::survey_prior {

/// Legs underground that are no duplicates, less `offset_m`. Stations that a leg of less than a centimetre
/// joins are one.
///
/// Distances to the walls come from the section at a station that was noted on the leg's run, else from
/// another one that looks along the leg, else from the splays across it, each on its own; else they are
/// core::kUnmeasuredWall_m.
///
/// Leads are stations that the surveyor marked (Therion's `continuation`), and those with a single leg unless
/// they are entrances, or a leg over ground ends there.
core::SurveyPrior prior_of(const survey::Survey& survey, const core::Vec3& offset_m);

/// Where the cave's origin is in the coordinates of the survey, if `karst cave from-survey` has made the
/// cave: by the stations of OUT.stations.csv beside `cave` that have the same name (the median on each axis).
/// Zero if there is no such file. Throws core::InputError naming `file`, the survey's, if no name is the
/// same.
core::Vec3 offset_of(const std::string& file, const survey::Survey& survey, const std::string& cave);

/// "x y z" in metres, separated by blanks. Throws core::InputError naming `source` and `key`.
core::Vec3 read_offset(const std::string& source, const std::string& key, const std::string& text);
/// As read_offset() reads it.
std::string offset_text(const core::Vec3& offset_m);

}  // namespace karst::survey_prior
