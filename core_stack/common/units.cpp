#include "core_stack/common/units.h"

#include <array>
#include <cmath>
#include <numbers>

namespace karst::core {
namespace {

struct Unit {
  std::string_view name, dimension;
  double in_si;
};
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array kUnits = {
    Unit{"m", "length", 1},
    Unit{"cm", "length", 0.01},
    Unit{"mm", "length", 0.001},
    Unit{"km", "length", 1000},
    Unit{"ft", "length", 0.3048},
    Unit{"in", "length", 0.0254},
    Unit{"s", "time", 1},
    Unit{"ms", "time", 0.001},
    Unit{"min", "time", 60},
    Unit{"h", "time", 3600},
    Unit{"m/s", "speed", 1},
    Unit{"km/h", "speed", 1 / 3.6},
    Unit{"m/s^2", "acceleration", 1},
    Unit{"m/s^3", "jerk", 1},
    Unit{"rad", "angle", 1},
    Unit{"deg", "angle", kDegree},
    Unit{"rad/s", "angular rate", 1},
    Unit{"deg/s", "angular rate", kDegree},
    Unit{"rad/s^2", "angular acceleration", 1},
    Unit{"deg/s^2", "angular acceleration", kDegree},
    Unit{"kg", "mass", 1},
    Unit{"g", "mass", 0.001},
    Unit{"N", "force", 1},
    Unit{"W", "power", 1},
    Unit{"kW", "power", 1000},
    Unit{"Wh", "energy", 1},
    Unit{"%", "percentage", 1},
    Unit{"Hz", "frequency", 1},
    Unit{"uT", "magnetic field", 1},
    Unit{"m^3", "volume", 1},
    Unit{"1/m", "extinction", 1},
    Unit{"1/km", "extinction", 0.001},
    Unit{"sr", "solid angle", 1},
    Unit{"cd", "luminous intensity", 1},
    Unit{"cd/m^2", "luminance", 1},
    Unit{"1/s", "gain", 1},
    Unit{"1/s^2", "stiffness gain", 1},
    Unit{"1/s^3", "integral gain", 1},
};

const Unit* find(std::string_view name) {
  for (const Unit& u : kUnits)
    if (u.name == name) return &u;
  return nullptr;
}

}  // namespace

std::optional<double> unit_factor(std::string_view from, std::string_view to) {
  if (from == to) return 1.0;
  const Unit* a = find(from);
  const Unit* b = find(to);
  if (a == nullptr || b == nullptr || a->dimension != b->dimension) return std::nullopt;
  return a->in_si / b->in_si;
}

}  // namespace karst::core
