// The path loss of a radio link between two positions in a cave.
//
// In air the loss grows with the distance by the log-distance law, 10 n log10(d) dB. Every metre of rock on
// the straight line adds a fixed number of dB. The link budget is the loss of air over `range`: without rock
// a link reaches exactly `range`.
//
// Figures. Rock: a wave in a material of little loss is damped by 1636 sigma / sqrt(epsilon_r) dB/m, sigma in
// S/m (plane wave, loss tangent well below 1: Annan, Ground Penetrating Radar Principles, as 1.64 sigma /
// sqrt(K) with sigma in mS/m; ITU-R P.2040, annex 1). Massive limestone has epsilon_r 6 to 8 and, at UHF, 1
// to 20 mS/m from dry to wet: 0.6 to 13 dB/m. The default of 3 dB/m is 5 mS/m at 7; wet clay takes tens. Air:
// n = 2 is free space, and rough galleries in line of sight are found close to it.
//
// Not modelled: wave guiding in passages above some hundred MHz, which extends the range along straight ones;
// reflection and diffraction, which carry part of the signal around bends. Both would help: the model
// underestimates contact in bends, and covers fading by interference only as the random part in
// `fading_db`.
#pragma once
#include "core_stack/common/options.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::sim {

/// rock: the model of this file; distance: all packets within the range are received, as in the paper.
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

/// Metres of rock on the straight line between two positions in the air. If an odd number of surfaces is
/// crossed, because the mesh has holes or overlaps, all from the first surface to the last counts as rock.
double rock_between_m(const cave::RayScene& scene, const core::Vec3& a, const core::Vec3& b);

/// Link margin in dB above the receiver's sensitivity; negative: too weak. With Propagation::distance:
/// +infinity within the range, -infinity beyond.
double link_margin_db(const LinkOptions& o, const cave::RayScene& scene, const core::Vec3& a,
                      const core::Vec3& b);

}  // namespace karst::sim
