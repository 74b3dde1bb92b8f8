#include "sdk/survey_prior/survey_prior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/input_file.h"
#include "sdk/survey/place_sets.h"
#include "sdk/survey_prior/walls.h"

namespace karst::survey_prior {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using core::Vec3;
using survey::Leg;
using survey::Survey;

bool is_passage(const Leg& leg) { return !leg.surface && !leg.duplicate && leg.from != leg.to; }

double length_m(const Survey& survey, const Leg& leg) {
  return (survey.stations[leg.to].position_m - survey.stations[leg.from].position_m).norm();
}

/// By station: the one that stands for it and for those that are in the same place.
std::vector<std::uint32_t> places_of(const Survey& survey) {
  constexpr double kSamePlace_m = 0.01;
  survey::PlaceSets places(survey.stations.size());
  for (const Leg& leg : survey.legs)
    if (is_passage(leg) && length_m(survey, leg) < kSamePlace_m) places.unite(leg.from, leg.to);
  std::vector<std::uint32_t> place(survey.stations.size());
  for (std::uint32_t s = 0; s < place.size(); ++s) place[s] = places.root(s);
  return place;
}

struct NamedPlace {
  std::string name;
  Vec3 position_m;
};

/// A line "name,x,y,z,flags" of OUT.stations.csv, whose name may be in quotes.
std::optional<NamedPlace> place_of_line(const std::string& line) {
  std::array<std::size_t, 4> comma{};
  std::size_t end = line.size();
  for (auto c = comma.rbegin(); c != comma.rend(); ++c) {
    if (end == 0) return std::nullopt;
    *c = line.rfind(',', end - 1);
    if (*c == std::string::npos) return std::nullopt;
    end = *c;
  }
  NamedPlace place{line.substr(0, comma[0]), Vec3::Zero()};
  std::istringstream numbers(line.substr(comma[0] + 1, comma[1] - comma[0] - 1) + ' ' +
                             line.substr(comma[1] + 1, comma[2] - comma[1] - 1) + ' ' +
                             line.substr(comma[2] + 1, comma[3] - comma[2] - 1));
  Vec3& p = place.position_m;
  if (!(numbers >> p.x() >> p.y() >> p.z()) || !p.allFinite()) return std::nullopt;
  if (place.name.size() >= 2 && place.name.front() == '"' && place.name.back() == '"') {
    std::string plain;
    for (std::size_t i = 1; i + 1 < place.name.size(); ++i) {
      plain += place.name[i];
      if (place.name[i] == '"') ++i;  // it is doubled
    }
    place.name = std::move(plain);
  }
  return place;
}

std::vector<NamedPlace> read_stations(const std::string& file) {
  std::istringstream in(core::read_input(file, core::kMaxTextFileBytes));
  std::vector<NamedPlace> places;
  std::string line;
  std::getline(in, line);  // the names of the columns
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (line.empty()) continue;
    std::optional<NamedPlace> place = place_of_line(line);
    if (!place)
      throw InputError(file, "line " + std::to_string(number),
                       "expected name,x,y,z,flags, got \"" + line + "\"");
    places.push_back(std::move(*place));
  }
  return places;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

core::SurveyPrior prior_of(const Survey& survey, const Vec3& offset_m) {
  const std::vector<std::uint32_t> place = places_of(survey);
  core::SurveyPrior prior;
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(survey.stations.size(), kNone), legs_at(survey.stations.size());
  const auto station = [&](std::uint32_t s) {
    if (number[s] == kNone) {
      number[s] = static_cast<std::uint32_t>(prior.stations.size());
      prior.stations.emplace_back(survey.stations[s].position_m - offset_m);
    }
    return number[s];
  };
  const Walls walls(survey);
  for (const Leg& leg : survey.legs) {
    const std::uint32_t from = place[leg.from], to = place[leg.to];
    if (!is_passage(leg) || from == to) continue;
    ++legs_at[from], ++legs_at[to];
    const std::uint32_t first = station(from), second = station(to);
    prior.legs.push_back({first, second, walls.at(leg, leg.from), walls.at(leg, leg.to)});
  }

  std::vector<char> to_outside(survey.stations.size()), noted(survey.stations.size());
  for (std::uint32_t s = 0; s < survey.stations.size(); ++s) {
    if (survey.stations[s].entrance) to_outside[place[s]] = 1;
    if (survey.stations[s].continuation) noted[place[s]] = 1;
  }
  for (const Leg& leg : survey.legs)
    if (leg.surface) to_outside[place[leg.from]] = to_outside[place[leg.to]] = 1;
  for (std::uint32_t s = 0; s < survey.stations.size(); ++s)
    if (number[s] != kNone && (noted[s] != 0 || (legs_at[s] == 1 && to_outside[s] == 0)))
      prior.leads.push_back({number[s], noted[s] != 0});
  std::sort(prior.leads.begin(), prior.leads.end(),
            [](const core::SurveyLead& a, const core::SurveyLead& b) { return a.station < b.station; });
  return prior;
}

std::optional<StationFit> station_fit(const std::string& file, const Survey& survey, const std::string& cave,
                                      const std::optional<Vec3>& given_m) {
  const fs::path stations = fs::path(cave).replace_extension(".stations.csv");
  if (cave.empty() || !fs::exists(stations)) return std::nullopt;
  std::map<std::string, Vec3> named;
  for (const survey::Station& s : survey.stations) {
    named.emplace(s.name, s.position_m);
    for (const std::string& alias : s.aliases) named.emplace(alias, s.position_m);
  }
  std::vector<Vec3> differences;
  for (const NamedPlace& place : read_stations(stations.string()))
    if (const auto found = named.find(place.name); found != named.end())
      differences.emplace_back(found->second - place.position_m);
  StationFit fit;
  fit.names = differences.size();
  if (given_m) fit.offset_m = *given_m;
  if (differences.empty()) {
    if (given_m) return fit;
    throw InputError(file, "",
                     "has no station of " + stations.string() +
                         ": where it lies in the cave is not known; give survey.offset");
  }
  if (!given_m)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::vector<double> along;
      for (const Vec3& d : differences) along.push_back(d[axis]);
      fit.offset_m[axis] = median(std::move(along));
    }
  std::vector<double> residuals;
  for (const Vec3& d : differences) residuals.push_back((d - fit.offset_m).norm());
  fit.greatest_m = *std::max_element(residuals.begin(), residuals.end());
  fit.median_m = median(std::move(residuals));
  if (!given_m && fit.median_m > kMostResidual_m)
    throw InputError(file, "",
                     core::format_text("contradicts the cave: after the best offset, %s, half of the %zu "
                                       "stations of the same name as in %s are %.1f m or more apart, at "
                                       "most %.1f m; the names mean other stations, or a survey is wrong. "
                                       "If it fits nevertheless, give survey.offset",
                                       offset_text(fit.offset_m).c_str(), fit.names,
                                       stations.string().c_str(), fit.median_m, fit.greatest_m));
  return fit;
}

double distance_to_legs_m(const core::SurveyPrior& prior, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const core::SurveyedLeg& leg : prior.legs) {
    const Vec3 &a = prior.stations[leg.from], along = prior.stations[leg.to] - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (a + t * along - p).norm());
  }
  return nearest;
}

Vec3 read_offset(const std::string& source, const std::string& key, const std::string& text) {
  std::istringstream in(text);
  Vec3 p;
  std::string more;
  if (!(in >> p.x() >> p.y() >> p.z()) || in >> more || !p.allFinite())
    throw InputError(source, key, "expected \"x y z\" in metres, got \"" + text + "\"");
  return p;
}

std::string offset_text(const Vec3& offset_m) {
  return core::format_text("%.3f %.3f %.3f", offset_m.x(), offset_m.y(), offset_m.z());
}

}  // namespace karst::survey_prior
