#include <algorithm>
#include <cmath>
#include <optional>

#include "plugins/simulator/cave_generator/field.h"

namespace karst::cave {
namespace {

using core::Random;
using core::Vec3;

constexpr double kAwayFromStartM = 6;
constexpr double kCubeM = 2.4;

/// First rock from a free place straight up (1) or down (-1).
std::optional<Vec3> rock_along(const CaveField& field, Vec3 p, double sign) {
  if (field.value(p) > -0.1) return std::nullopt;
  constexpr double kStep = 0.2;
  for (double s = 0; s < 20; s += kStep) {
    const Vec3 next = p + Vec3(0, 0, sign * kStep);
    if (field.value(next) < 0) {
      p = next;
      continue;
    }
    double inside = 0, outside = kStep;
    for (int i = 0; i < 6; ++i) {
      const double middle = 0.5 * (inside + outside);
      (field.value(p + Vec3(0, 0, sign * middle)) < 0 ? inside : outside) = middle;
    }
    return p + Vec3(0, 0, sign * inside);
  }
  return std::nullopt;
}

/// A position in the cave and the free distance to its sides.
struct Site {
  Vec3 center = Vec3::Zero();
  double half_width_m = 1;
};

std::vector<Site> sites(const CavePlan& plan) {
  std::vector<Site> out;
  for (const Passage& passage : plan.passages)
    for (std::size_t i = 0; i + 1 < passage.size(); ++i) {
      const Vec3 step = passage[i + 1].center - passage[i].center;
      if (std::abs(step.z()) > 0.8 * step.norm()) continue;  // nothing lies in a shaft
      if ((passage[i].center - plan.start).norm() < kAwayFromStartM) continue;
      out.push_back({passage[i].center, passage[i].half_width_m});
    }
  for (std::size_t i = 1; i < plan.chambers.size(); ++i)  // chambers have more room, and more lies in them
    for (int n = 0; n < 2; ++n)
      out.push_back(
          {Vec3(plan.chambers[i].center.x(), plan.chambers[i].center.y(), plan.chambers[i].floor_z + 1.5),
           0.8 * plan.chambers[i].radii.head<2>().minCoeff()});
  return out;
}

Vec3 scattered(const Site& site, double radius_m, Random& random) {
  const double angle = random.uniform(0, 2 * std::numbers::pi), r = radius_m * std::sqrt(random.uniform());
  return site.center + Vec3(r * std::cos(angle), r * std::sin(angle), 0);
}

core::Quat tilted(Random& random, double lean_rad) {
  const double turn = random.uniform(0, 2 * std::numbers::pi),
               towards = random.uniform(0, 2 * std::numbers::pi);
  return core::Quat(Eigen::AngleAxisd(lean_rad, Vec3(std::cos(towards), std::sin(towards), 0))) *
         core::from_heading(turn);
}

void add_heap(CavePlan& plan, const CaveField& field, const Site& site, Random& random) {
  const double spread = random.uniform(0.5, 1.0) * site.half_width_m;
  const Site heap{scattered(site, 0.5 * site.half_width_m, random), spread};
  const int blocks = static_cast<int>(random.uniform(4, 9) * std::clamp(spread, 1.0, 4.0));
  for (int i = 0; i < blocks; ++i) {
    const Vec3 above = scattered(heap, spread, random);
    const double size = 0.3 * std::exp(0.5 * random.normal()) * std::clamp(site.half_width_m / 2.5, 0.7, 2.0);
    // One statement a draw: compilers differ in the order in which they evaluate arguments.
    const double height = random.uniform(0.45, 0.9), width = random.uniform(0.7, 1.1);
    const Vec3 half = std::clamp(size, 0.22, 1.4) * Vec3(random.uniform(0.8, 1.4), width, height);
    const double lean = 0.35 * random.normal();
    const auto floor = rock_along(field, above, -1);
    // Towards the middle of the heap blocks lie on top of others.
    const double piled =
        0.6 * std::max(0.0, 1 - (above - heap.center).head<2>().norm() / spread) * random.uniform();
    if (floor)
      plan.boulders.push_back({*floor + Vec3(0, 0, half.z() * 0.4 + piled), half, tilted(random, lean)});
  }
}

void add_dripstone(CavePlan& plan, const CaveField& field, const Site& site, Random& random) {
  const int pieces = 3 + static_cast<int>(random.uniform() * 8);
  const Site cluster{scattered(site, 0.6 * site.half_width_m, random), site.half_width_m};
  for (int i = 0; i < pieces; ++i) {
    const Vec3 at = scattered(cluster, 0.5 * site.half_width_m, random);
    const double base = random.uniform(0.22, 0.5), wish = 0.5 * std::exp(0.6 * random.normal());
    const double kind = random.uniform();
    const auto floor = rock_along(field, at, -1), ceiling = rock_along(field, at, 1);
    if (!floor || !ceiling) continue;
    const double height = ceiling->z() - floor->z();
    const double length = std::min({0.45 * height, wish * (1 + 0.15 * height), 4.0});
    const Vec3 sunk(0, 0, 0.4 * base);
    if (kind < 0.1 && height < 6) {
      plan.speleothems.push_back({*floor - sunk, 0.5 * (*floor + *ceiling), base, 0.6 * base});
      plan.speleothems.push_back({*ceiling + sunk, 0.5 * (*floor + *ceiling), base, 0.6 * base});
    } else if (kind < 0.6) {
      plan.speleothems.push_back({*ceiling + sunk, *ceiling - Vec3(0, 0, length), base, 0.12});
    } else {
      plan.speleothems.push_back({*floor - sunk, *floor + Vec3(0, 0, 0.8 * length), base, 0.5 * base});
    }
  }
}

}  // namespace

void furnish(CavePlan& plan, const CaveRecipe& recipe, std::uint64_t seed) {
  plan.boulders.clear();
  plan.speleothems.clear();
  const CavePlan bare = plan;
  const CaveField field(bare, kCubeM, 0.5);
  const std::vector<Site> all = sites(plan);
  if (all.empty()) return;
  const auto scatter = [&](double per_station, const char* what, const auto& add) {
    Random random = Random::stream(seed, what);
    const int count = static_cast<int>(per_station * static_cast<double>(all.size()));
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size()));
      add(plan, field, all[k], random);
    }
  };
  scatter(0.22 * recipe.breakdown, "breakdown", add_heap);
  scatter(0.22 * recipe.speleothems, "speleothems", add_dripstone);
}

}  // namespace karst::cave
