#include "core_stack/homing/landing_place.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "core_stack/homing/home.h"

namespace karst::core {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// The lowest of the roadmap's nodes in each column of cells, in the columns' order.
std::vector<Vec3> candidates_of(const VoxelMap& map, const Roadmap& roadmap, const LandingRequest& request) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::map<std::int32_t, Vec3>> columns;
  for (const Vec3& a : request.around)
    for (const Vec3& p : roadmap.places_near(a, request.reach_m)) {
      const CellKey k = map.key_of(p);
      columns[{k.x, k.y}].emplace(k.z, p);
    }
  std::vector<Vec3> out;
  // Of several storeys each has its own floor: nodes more than two metres apart are not of one.
  for (const auto& [xy, heights] : columns) {
    double last_z = -kInf;
    for (const auto& [z, p] : heights) {
      if (p.z() - last_z > 2) out.push_back(p);
      last_z = p.z();
    }
  }
  return out;
}

/// Fills in what the links to the nodes are like.
void judge_links(const VoxelMap& map, const LandingRequest& request, const LandingOptions& options,
                 LandingPlace& place) {
  const Vec3 antenna = place.ground + Vec3(0, 0, request.vehicle_radius_m);
  place.extension_m = kInf, place.margin_db = -kInf;
  for (std::size_t i = 0; i < request.nodes.size(); ++i) {
    const double d = (request.nodes[i] - antenna).norm();
    if (d < place.extension_m) place.extension_m = d, place.nearest_node = i;
    const double margin_db = expected_margin_db(map, antenna, request.nodes[i], options.link);
    place.margin_db = std::max(place.margin_db, margin_db);
    place.links += margin_db >= 0;
  }
}

}  // namespace

void describe(OptionTable& t, LandingOptions& o) {
  t.add("ground_margin", o.ground.margin_m, "m", 0, 2, "ground looked at beyond the vehicle's radius");
  t.add("most_slope", o.ground.most_slope_deg, "", 1, 45, "degrees; steeper ground is not landed on");
  t.add("most_step", o.ground.most_step_m, "m", 0.05, 1, "rougher ground is not landed on");
  t.add("most_drop", o.ground.most_drop_m, "m", 0.5, 20, "from where the descent begins to the ground");
  t.section("link", o.link);
  t.add("least_extension", o.least_extension_m, "m", 0, 500, "a relay lands no nearer to another");
  t.add("keep_apart", o.keep_apart_m, "m", 0.5, 50, "from places of other vehicles");
  t.add("passage_reach", o.passage_reach_m, "m", 1, 10, "others must get by within that of a landed one");
  t.add("second_link", o.second_link_m, "m", 0, 100, "extension that a second node in reach is worth");
  t.add("second", o.second_m, "m", 0, 100, "extension that a second of flight less is worth");
  t.add("landing_speed", o.landing_speed_mps, "m/s", 0.05, 2, "of the descent");
  t.add("most_places", o.most_places, 1, 100, "places looked for");
}

const char* landing_refusal_text(LandingRefusal r) {
  constexpr std::array<const char*, kLandingRefusals> texts = {"no ground that is known, flat and clear",
                                                               "out of the relays' reach",
                                                               "too near to a relay to extend the reach",
                                                               "too near to another vehicle",
                                                               "no way there",
                                                               "too far for the time left",
                                                               "others could not get by"};
  return texts[static_cast<std::size_t>(r)];
}

LandingSearch find_landing_places(const VoxelMap& map, const Roadmap& roadmap, const LandingRequest& request,
                                  const LandingOptions& options, const PlanningOptions& planning,
                                  const MotionLimits& limits) {
  LandingSearch search;
  const auto refuse = [&search](LandingRefusal r) { ++search.refused[static_cast<std::size_t>(r)]; };
  std::vector<LandingPlace> found;
  for (const Vec3& hover : candidates_of(map, roadmap, request)) {
    ++search.candidates;
    const Ground ground = ground_below(map, hover, request.vehicle_radius_m, options.ground);
    LandingPlace place;
    place.hover = hover, place.ground = ground.ground;
    place.slope_rad = ground.slope_rad, place.step_m = ground.step_m;
    if (ground.verdict != GroundVerdict::good) {
      refuse(LandingRefusal::ground);
      continue;
    }
    judge_links(map, request, options, place);
    const bool near_others = std::any_of(request.others.begin(), request.others.end(), [&](const Vec3& o) {
      return (o - place.ground).norm() < options.keep_apart_m || (o - hover).norm() < options.keep_apart_m;
    });
    if (place.margin_db < 0)
      refuse(LandingRefusal::out_of_reach);
    else if (place.extension_m < options.least_extension_m)
      refuse(LandingRefusal::no_extension);
    else if (near_others)
      refuse(LandingRefusal::too_near_others);
    else
      found.push_back(place);
  }

  std::vector<Vec3> hovers;
  for (const LandingPlace& p : found) hovers.push_back(p.hover);
  const std::vector<double> ways =
      hovers.empty() ? std::vector<double>{} : roadmap.distances(map, request.from, hovers, 0.0);
  std::vector<LandingPlace> reached;
  for (std::size_t i = 0; i < found.size(); ++i) {
    LandingPlace& p = found[i];
    if (ways[i] == kInf) {
      refuse(LandingRefusal::no_way);
      continue;
    }
    p.time_s = flight_time_s(ways[i], limits) + (p.hover - p.ground).z() / options.landing_speed_mps;
    if (p.time_s > request.most_time_s) {
      refuse(LandingRefusal::no_time);
      continue;
    }
    p.score = p.extension_m + (p.links > 1 ? options.second_link_m : 0) - options.second_m * p.time_s;
    reached.push_back(p);
  }
  std::sort(reached.begin(), reached.end(), [](const LandingPlace& a, const LandingPlace& b) {
    const auto key = [](const LandingPlace& p) {
      return std::tuple(-p.score, p.hover.x(), p.hover.y(), p.hover.z());
    };
    return key(a) < key(b);
  });
  for (const LandingPlace& p : reached) {
    if (search.places.size() >= static_cast<std::size_t>(options.most_places)) break;
    const Vec3 standing = p.ground + Vec3(0, 0, request.vehicle_radius_m);
    if (others_get_by(map, standing, request.vehicle_radius_m,
                      search_clearance_m(planning, map.resolution_m()), options.passage_reach_m))
      search.places.push_back(p);
    else
      refuse(LandingRefusal::in_the_way);
  }
  return search;
}

}  // namespace karst::core
