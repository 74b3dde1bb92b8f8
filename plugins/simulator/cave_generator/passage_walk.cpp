#include "plugins/simulator/cave_generator/passage_walk.h"

#include <algorithm>
#include <cmath>

#include "plugins/simulator/cave_generator/noise.h"

namespace karst::cave {

using core::Random;
using core::Vec3;

namespace {

Station section(const CaveRecipe& recipe, double s, double width_factor, std::uint32_t noise, bool keyhole) {
  const double size =
      std::exp(0.65 * gradient_noise(s / 11, noise + 1) + 0.3 * gradient_noise(s / 4, noise + 2));
  const double aspect = std::exp(0.55 * gradient_noise(s / 17, noise + 3) - 0.25);
  const double width = 0.5 * recipe.passage_width_m * width_factor * size;
  Station out;
  out.half_width_m = std::max(kMinHalfM, width);
  out.half_height_m = std::max(kMinHalfM, width * aspect);
  const double sediment = 0.75 + 0.35 * gradient_noise(s / 9, noise + 4);
  out.floor_m = std::max(kMinHalfM, sediment * out.half_height_m);
  const double cut = gradient_noise(s / 20, noise + 5) + 0.25;
  if (keyhole) out.slot = std::clamp(2 * cut, 0.0, 0.9);
  return out;
}

/// The present end of a passage and its direction there.
struct Front {
  Vec3 at;
  double heading_rad, pitch_rad;
};

double freest_turn(const CavePlan& plan, const CaveRecipe& recipe, const Front& front, const Vec3& but,
                   const Passage& own) {
  double best = 0, best_score = -1e9;
  for (const double offset : {0.0, 0.12, -0.12, 0.25, -0.25, 0.4, -0.4}) {
    const Vec3 ahead = direction(front.heading_rad + offset, front.pitch_rad);
    const double near = room(plan, recipe, front.at + 5 * ahead, but, own),
                 far = room(plan, recipe, front.at + 10 * ahead, but, own);
    const double score = std::min(near, 2.0) + 0.5 * std::min(far, 2.0) - 2.5 * std::abs(offset);
    if (score > best_score) {
      best_score = score;
      best = offset;
    }
  }
  return best;
}

void taper(Passage& passage) {
  const std::size_t n = std::min<std::size_t>(passage.size() - 1, 4);
  for (std::size_t i = 0; i < n; ++i) {
    Station& s = passage[passage.size() - n + i];
    const double shrink = 1 - 0.45 * static_cast<double>(i + 1) / static_cast<double>(n);
    s.half_width_m = std::max(kMinHalfM, s.half_width_m * shrink);
    s.half_height_m = std::max(kMinHalfM, s.half_height_m * shrink);
    s.floor_m = std::max(kMinHalfM, s.floor_m * shrink);
  }
}

}  // namespace

Vec3 direction(double heading, double pitch) {
  return {std::cos(pitch) * std::cos(heading), std::cos(pitch) * std::sin(heading), std::sin(pitch)};
}

double room(const CavePlan& plan, const CaveRecipe& recipe, const Vec3& p, const Vec3& but,
            const Passage& own) {
  const double self = 0.5 * recipe.passage_width_m, ignored = 2.2 * recipe.passage_width_m + 3;
  double least = 20;
  const auto meet = [&](const Station& s) {
    least = std::min(least, (s.center - p).norm() - std::max(s.half_width_m, s.half_height_m) - self - 1.5);
  };
  for (const Passage& passage : plan.passages)
    for (const Station& s : passage)
      if ((s.center - but).norm() > ignored) meet(s);
  const auto recent = static_cast<std::size_t>(ignored / kStationStepM);
  for (std::size_t i = 0; i + recent < own.size(); ++i) meet(own[i]);
  return least;
}

double passages_length_m(const CavePlan& plan) {
  double sum = 0;
  for (const Passage& p : plan.passages) sum += kStationStepM * static_cast<double>(p.size() - 1);
  return sum;
}

Passage walk_passage(const CavePlan& plan, const CaveRecipe& recipe, std::uint64_t seed, const Walk& w,
                     const std::string& name) {
  Random random = Random::stream(seed, name);
  const auto noise = static_cast<std::uint32_t>(random.bits());
  const double steepness = 0.06 + 0.6 * recipe.verticality;
  const double trend = w.pitch_rad + steepness * 0.5 * random.normal();
  const bool keyhole = random.uniform() < 0.3;
  double heading = w.heading_rad, turn = 0;
  Vec3 p = w.from;
  Passage passage;
  const int steps = std::max(3, static_cast<int>(w.length_m / kStationStepM));
  for (int i = 0; i <= steps; ++i) {
    const double s = i * kStationStepM;
    Station station = section(recipe, s, w.width_factor, noise, keyhole);
    station.center = p;
    if (w.level_start && s < kLevelStartM) {
      station.floor_m = p.z();
      station.slot = 0;
    }
    passage.push_back(station);
    turn = 0.8 * turn + 0.07 * random.normal();
    // Water follows joints: now and then it turns a corner.
    if (random.uniform() < 0.05) turn += random.uniform() < 0.5 ? -0.22 : 0.22;
    double pitch = trend + steepness * 1.3 * gradient_noise(s / 14, noise + 7);
    pitch = std::clamp(pitch, -1.05, 1.05);
    if (w.level_start && s < kLevelStartM) pitch = 0;
    const double best = freest_turn(plan, recipe, {p, heading + turn, pitch}, w.from, passage);
    heading += turn + best;
    p += kStationStepM * direction(heading, pitch);
    // A walk that meets another passage ends there.
    if (i > 6 && i + 1 < steps &&
        room(plan, recipe, p + 3 * direction(heading, pitch), w.from, passage) < -1.5)
      break;
  }
  taper(passage);
  return passage;
}

}  // namespace karst::cave
