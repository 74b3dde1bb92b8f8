// Which legs of a survey become rock.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sdk/survey/survey.h"

namespace karst::survey_cave {

/// All that is given must hold.
struct PartOptions {
  std::string survey;  // names of a survey, such as "system.branch" or "branch": what lies in it
  std::string around;  // a station: what is within the radius of it
  double radius_m = 150;
  std::optional<Eigen::AlignedBox3d> box;  // in the survey's coordinates
};

struct SurveyPart {
  std::vector<std::uint32_t> legs;        // ascending indices into Survey::legs
  std::vector<std::uint32_t> stations;    // at the ends of those, ascending
  double surface_m = 0, duplicate_m = 0;  // of legs with both ends in the part that are left out for that
  double whole_m = 0;                     // of all passages of the survey
};

/// The legs underground that are no duplicates and have both ends in the part. Throws core::InputError naming
/// `file`: if there is no such survey or station, with the nearest name, or if no leg is left.
SurveyPart part_of(const std::string& file, const survey::Survey& survey, const PartOptions& options);

/// "system.branch" of "system.branch.12"; "" if the name has no survey.
std::string survey_of(const std::string& station);

/// The station of that name, or of one that ends in "." and that name if there is just one. Throws
/// core::InputError naming `file`.
std::uint32_t station_named(const std::string& file, const survey::Survey& survey, const std::string& name);

}  // namespace karst::survey_cave
