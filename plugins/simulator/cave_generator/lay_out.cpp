// The passages of a cave, and the chambers, shafts, chimneys and loops that hang on them.
#include <algorithm>
#include <cmath>
#include <optional>

#include "plugins/simulator/cave_generator/noise.h"
#include "plugins/simulator/cave_generator/passage_walk.h"

namespace karst::cave {
namespace {

using core::Random;
using core::Vec3;

struct Spot {
  std::size_t passage = 0, station = 0;
};

/// Picks a station away from the start and from the ends of its passage.
std::optional<Spot> pick(const CavePlan& plan, Random& random, double from_start_m) {
  for (int attempt = 0; attempt < 40; ++attempt) {
    const double at = random.uniform();
    std::size_t total = 0;
    for (const Passage& p : plan.passages) total += p.size();
    auto i = static_cast<std::size_t>(at * static_cast<double>(total));
    Spot spot;
    while (i >= plan.passages[spot.passage].size()) i -= plan.passages[spot.passage++].size();
    spot.station = i;
    const Passage& p = plan.passages[spot.passage];
    if (i < 3 || i + 3 >= p.size() || (p[i].center - plan.start).norm() < from_start_m) continue;
    return spot;
  }
  return std::nullopt;
}

double heading_at(const Passage& p, std::size_t i) {
  const Vec3 d = p[std::min(i + 1, p.size() - 1)].center - p[i - 1].center;
  return std::atan2(d.y(), d.x());
}

void add_entrance(CavePlan& plan, const CaveRecipe& recipe, Random& random) {
  const double radius = std::max(3.6, 0.8 * recipe.passage_width_m);
  Chamber c;
  c.heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  c.center = Vec3(0, 0, 0.25 * radius);
  c.radii = Vec3(1.15 * radius, radius, std::max(2.9, 0.75 * radius));
  plan.start_heading_rad = c.heading_rad;
  plan.chambers.push_back(c);
}

void add_dome(CavePlan& plan, const CaveRecipe& recipe, Random& random) {
  std::optional<Spot> spot;  // the one of a few that is farthest from other chambers
  double apart = 0;
  for (int attempt = 0; attempt < 8; ++attempt) {
    const auto other = pick(plan, random, 14);
    if (!other) continue;
    double nearest = 1e9;
    for (const Chamber& c : plan.chambers)
      nearest = std::min(nearest, (c.center - plan.passages[other->passage][other->station].center).norm());
    if (nearest > apart) {
      apart = nearest;
      spot = other;
    }
  }
  const double size = recipe.passage_width_m * random.uniform(0.9, 1.6), high = random.uniform(0.6, 1.3),
               oblong = random.uniform(0.75, 1.3), heading = random.uniform(0, std::numbers::pi);
  if (!spot) return;
  const Station& s = plan.passages[spot->passage][spot->station];
  Chamber c;
  c.radii = Vec3(size * oblong, size / oblong, std::max(2.5, size * high));
  c.center = s.center + Vec3(0, 0, 0.35 * c.radii.z());
  c.heading_rad = heading;
  c.floor_z = s.center.z() - s.floor_m - 0.3;
  plan.chambers.push_back(c);
  for (int lobe = 0; lobe < 3; ++lobe) {  // one ellipsoid alone would look turned on a lathe
    const double towards = heading + 2.1 * lobe + random.uniform(-0.6, 0.6), part = random.uniform(0.45, 0.7);
    Chamber bay = c;
    bay.radii = part * c.radii;
    bay.radii.z() = std::max(2.0, bay.radii.z() * random.uniform(0.8, 1.4));
    bay.heading_rad = towards;
    bay.center += size * random.uniform(0.5, 0.8) * direction(towards, 0) +
                  Vec3(0, 0, random.uniform(-0.2, 0.3) * c.radii.z());
    bay.floor_z += random.uniform(-0.4, 1.2);
    plan.chambers.push_back(bay);
  }
}

enum class Vertical { shaft, chimney };

/// Adds a vertical passage at a station: a shaft down, with a foot passage, or a chimney up.
void add_vertical(CavePlan& plan, const CaveRecipe& recipe, Random& random, Vertical kind, std::uint64_t seed,
                  const std::string& name) {
  const bool down = kind == Vertical::shaft;
  for (int attempt = 0; attempt < 12; ++attempt) {
    const auto spot = pick(plan, random, 10);
    if (!spot) return;
    const Station& s = plan.passages[spot->passage][spot->station];
    const double drop = random.uniform(7, 13) * (1 + recipe.verticality) + s.half_height_m;
    const double radius = std::max(1.25, recipe.passage_width_m * random.uniform(0.24, 0.4));
    const double sign = down ? -1 : 1;
    if (room(plan, recipe, s.center + Vec3(0, 0, sign * drop), s.center) < 2 ||
        room(plan, recipe, s.center + Vec3(0, 0, sign * (0.5 * drop + 3)), s.center) < 0)
      continue;
    Passage passage;
    const int steps = static_cast<int>(drop / kStationStepM);
    const auto noise = static_cast<std::uint32_t>(random.bits());
    Vec3 p = s.center;
    for (int i = 0; i <= steps; ++i) {
      Station v;
      v.center = p;
      const double taper = down ? 1 : 1 - 0.35 * i / steps;
      const double pulse = std::exp(0.3 * gradient_noise(i * kStationStepM / 4, noise));
      v.half_width_m = v.half_height_m = std::max(kMinHalfM, radius * taper * pulse);
      v.floor_m = v.half_height_m;
      passage.push_back(v);
      p += Vec3(0.25 * gradient_noise(i * 0.3, noise + 1), 0.25 * gradient_noise(i * 0.3, noise + 2),
                sign * kStationStepM);
    }
    const Vec3 foot = passage.back().center;
    plan.passages.push_back(std::move(passage));
    if (down)
      plan.passages.push_back(
          walk_passage(plan, recipe, seed,
                       {.from = foot,
                        .heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi),
                        .length_m = random.uniform(2, 4) * recipe.passage_width_m + 5,
                        .width_factor = 0.85},
                       name + " foot"));
    return;
  }
}

/// Adds a curved passage between two stations near in space but far apart along the passages, if any.
void add_loop(CavePlan& plan, const CaveRecipe& recipe, Random& random) {
  const double shortest = 2.5 * recipe.passage_width_m, longest = 6 * recipe.passage_width_m + 10;
  std::optional<std::pair<Spot, Spot>> best;
  double best_score = 1.0;
  for (int attempt = 0; attempt < 60; ++attempt) {
    const auto a = pick(plan, random, 8), b = pick(plan, random, 8);
    if (!a || !b) return;
    const Station &sa = plan.passages[a->passage][a->station], &sb = plan.passages[b->passage][b->station];
    const double apart = (sa.center - sb.center).norm();
    if (apart < shortest || apart > longest || std::abs(sa.center.z() - sb.center.z()) > 0.6 * apart)
      continue;
    if (a->passage == b->passage &&
        static_cast<double>(std::max(a->station, b->station) - std::min(a->station, b->station)) *
                kStationStepM <
            2 * apart)
      continue;
    const double clear = std::min(room(plan, recipe, 0.5 * (sa.center + sb.center), sa.center), 3.0);
    const double score = 3 + clear - apart / longest;
    if (score > best_score) {
      best_score = score;
      best = {*a, *b};
    }
  }
  if (!best) return;
  const Station a = plan.passages[best->first.passage][best->first.station];
  const Station b = plan.passages[best->second.passage][best->second.station];
  const Vec3 across = (b.center - a.center).cross(Vec3::UnitZ()).normalized();
  const double apart = (b.center - a.center).norm();
  const double bow = random.uniform(-0.25, 0.25) * apart, wave = random.uniform(-0.1, 0.1) * apart;
  Passage passage;
  const int steps = std::max(3, static_cast<int>(apart / kStationStepM));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double end = std::min(1.0, 4 * std::min(t, 1 - t));  // narrower in the middle than at its ends
    Station s;
    s.center = a.center + t * (b.center - a.center) +
               across * (bow * std::sin(std::numbers::pi * t) + wave * std::sin(2 * std::numbers::pi * t));
    s.half_width_m = std::max(kMinHalfM, (1 - 0.35 * end) * ((1 - t) * a.half_width_m + t * b.half_width_m));
    s.half_height_m =
        std::max(kMinHalfM, (1 - 0.35 * end) * ((1 - t) * a.half_height_m + t * b.half_height_m));
    s.floor_m = std::max(kMinHalfM, 0.8 * s.half_height_m);
    passage.push_back(s);
  }
  plan.passages.push_back(std::move(passage));
}

}  // namespace

CavePlan lay_out(const CaveRecipe& recipe, std::uint64_t seed, double length_m) {
  CavePlan plan;
  plan.roughness_m = std::min(recipe.roughness_m, 0.15 * recipe.passage_width_m);
  plan.undulation_m = 0.1 * recipe.passage_width_m;
  plan.undulation_length_m = 2 + recipe.passage_width_m;
  plan.noise_seed = static_cast<std::uint32_t>(Random::stream(seed, "walls").bits());
  Random entrance = Random::stream(seed, "entrance");
  add_entrance(plan, recipe, entrance);

  Walk main{.from = plan.start, .heading_rad = plan.start_heading_rad, .level_start = true};
  main.length_m = std::max(15.0, length_m * (1 - 0.65 * recipe.branching));
  plan.passages.push_back(walk_passage(plan, recipe, seed, main, "main passage"));
  Random branches = Random::stream(seed, "branches");
  for (int i = 0; recipe.branching > 0 && i < 400 && passages_length_m(plan) + 8 < length_m; ++i) {
    const auto spot = pick(plan, branches, 9);
    const double side = branches.uniform() < 0.5 ? -1 : 1, angle = branches.uniform(0.8, 1.7);
    const double length = recipe.passage_width_m * branches.uniform(2.5, 9),
                 factor = branches.uniform(0.6, 1);
    if (!spot) break;
    const Passage& parent = plan.passages[spot->passage];
    const Vec3 from = parent[spot->station].center;
    const double heading = heading_at(parent, spot->station) + side * angle;
    const double reach = 2 * recipe.passage_width_m + 4;
    if (room(plan, recipe, from + reach * direction(heading, 0), from) < 0.5) continue;
    plan.passages.push_back(
        walk_passage(plan, recipe, seed,
                     {.from = from,
                      .heading_rad = heading,
                      .length_m = std::min(length + 6, length_m - passages_length_m(plan)),
                      .width_factor = factor},
                     "branch " + std::to_string(i)));
  }
  const auto each = [&](std::int64_t count, const std::string& what, const auto& make) {
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string name = what + " " + std::to_string(i);
      Random random = Random::stream(seed, name);
      make(random, name);
    }
  };
  each(recipe.shafts, "shaft",
       [&](Random& r, const std::string& n) { add_vertical(plan, recipe, r, Vertical::shaft, seed, n); });
  each(recipe.chimneys, "chimney",
       [&](Random& r, const std::string& n) { add_vertical(plan, recipe, r, Vertical::chimney, seed, n); });
  each(recipe.loops, "loop", [&](Random& r, const std::string&) { add_loop(plan, recipe, r); });
  each(recipe.domes, "dome", [&](Random& r, const std::string&) { add_dome(plan, recipe, r); });
  return plan;
}

void scale_sections(CavePlan& plan, double factor) {
  for (Passage& passage : plan.passages)
    for (Station& s : passage) {
      s.half_width_m = std::max(kMinHalfM, factor * s.half_width_m);
      s.half_height_m = std::max(kMinHalfM, factor * s.half_height_m);
      const bool at_entrance = (s.center - plan.start).norm() < kLevelStartM;
      if (!at_entrance) s.floor_m = std::max(kMinHalfM, factor * s.floor_m);
    }
  for (std::size_t i = 1; i < plan.chambers.size(); ++i) plan.chambers[i].radii *= factor;
}

}  // namespace karst::cave
