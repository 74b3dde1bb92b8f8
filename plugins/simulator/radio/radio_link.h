// How much of a radio's power gets from one place in a cave to another.
//
// In air power falls with the distance by the log-distance law, 10 n log10(d) dB. Rock on the straight line
// takes a number of dB from every metre of it. The budget is what free air of the range takes: without rock a
// link reaches exactly `range`.
//
// Figures. Rock: a wave in a material of little loss is damped by 1636 sigma / sqrt(epsilon_r) dB/m, sigma in
// S/m (plane wave, loss tangent well below 1: Annan, Ground Penetrating Radar Principles, as 1.64 sigma /
// sqrt(K) with sigma in mS/m; ITU-R P.2040, annex 1). Massive limestone has epsilon_r 6 to 8 and, at UHF, 1
// to 20 mS/m from dry to wet: 0.6 to 13 dB/m. The default of 3 dB/m is 5 mS/m at 7; wet clay takes tens. Air:
// n = 2 is free space, and rough galleries in line of sight are found close to it.
//
// What is not modelled: that passages guide waves above some hundred MHz, which carries them farther along
// straight ones; reflection and diffraction, which carry some of them round bends. Both would help: the model
// errs on the side of less contact in bends, and says nothing of fading by interference but the random share
// in `fading_db`.
#pragma once
#include "core_stack/common/options.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::sim {

/// rock: what this file is about; distance: within the range all is heard, as in the paper.
enum class Propagation { rock, distance };
constexpr auto names_of(Propagation) {
  using enum Propagation;
  return std::to_array<core::Named<Propagation>>({{rock, "rock"}, {distance, "distance"}});
}

struct LinkOptions {
  Propagation propagation = Propagation::rock;
  double range_m = 50;
  double path_loss_exponent = 2.0;
  double rock_db_per_m = 3.0;
  double fading_db = 3.0;  // standard deviation, drawn anew for each packet
};
void describe(core::OptionTable& t, LinkOptions& o);

/// Metres of rock on the straight line between two places in the air. Where the mesh has holes or overlaps,
/// so that an odd number of surfaces is passed, all from the first surface to the last counts as rock.
double rock_between_m(const cave::RayScene& scene, const core::Vec3& a, const core::Vec3& b);

/// dB above what the receiver needs; negative: too weak. By distance alone: +-infinity within and beyond the
/// range.
double link_margin_db(const LinkOptions& o, const cave::RayScene& scene, const core::Vec3& a,
                      const core::Vec3& b);

}  // namespace karst::sim
