// How often maps of two flights are put together rightly, wrongly, or refused. Prints a line for each pair.
//
//   merge_campaign same A.bt B.bt [RUNS]       two flights of one cave, in one frame: both are cut so that
//   they
//                                              share 20 to 80 % of their rock, and B is moved at random
//   merge_campaign different A.bt B.bt ...     every pair, which have nothing in common
//   --clouds before the files                  as bare points, without free space; --six: gravity not known
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "core_stack/common/random.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/map_merge/map_registration.h"
#include "sdk/map_merge/merge_maps.h"

namespace {

using namespace karst::core;
using namespace karst::map_merge;

bool clouds = false;
MapRegistrationOptions options;

/// x below which a share of the rock lies.
double quantile_x(const VoxelMap& map, double fraction) {
  std::vector<double> x;
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    if (c == Cell::occupied) x.push_back(map.center_of(k).x());
  });
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(x.size())))];
}

/// The part of a map with x in [low, high], moved.
VoxelMap cut(const VoxelMap& map, double low, double high, const Pose& T) {
  MapOptions o;
  o.resolution_m = map.resolution_m();
  VoxelMap part(o), moved(o);
  map.for_each_known([&](const CellKey& k, Cell, float log_odds) {
    const double x = map.center_of(k).x();
    if (x >= low && x <= high) part.assign(k, 1, log_odds);
  });
  add_map(moved, part, T, o);
  return moved;
}

MapPiece piece(VoxelMap map) {
  MapPiece whole = piece_of(std::make_shared<VoxelMap>(std::move(map)));
  return clouds ? piece_of(whole.surface, whole.resolution_m) : whole;
}

struct Tally {
  int right = 0, refused = 0, wrong = 0;
  void print(const char* what) const {
    std::printf("%s: %d right, %d refused, %d WRONG\n", what, right, refused, wrong);
  }
};

/// `truth` null: any registration that is trusted is wrong.
void run(const char* what, const MapPiece& target, const MapPiece& source, const Pose* truth, Tally& tally) {
  const auto begin = std::chrono::steady_clock::now();
  const MapRegistration r = register_maps(target, source, options);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  double error_m = -1, error_deg = -1;
  if (truth) {
    error_m = 0;
    for (std::size_t i = 0; i < source.surface.size(); i += 50) {
      const Vec3 p = source.surface[i].cast<double>();
      error_m = std::max(error_m, (r.T_target_source * p - *truth * p).norm());
    }
    error_deg = r.T_target_source.orientation.angularDistance(truth->orientation) * 180 / std::numbers::pi;
  }
  const bool found = truth && error_m < 1.0;
  (r.trusted ? (found ? tally.right : tally.wrong) : tally.refused) += 1;
  std::printf(
      "%-28s %s%s off %.2f m %.2f deg  overlap %.2f/%.2f agreement %.3f residual %.3f hold %.3f rival %.2f "
      "area %.0f  %.1f s  %s\n",
      what, r.trusted ? "TRUSTED" : "refused", truth ? (found ? " (right)" : " (wrong)") : "", error_m,
      error_deg, r.overlay.source_overlap(), r.overlay.target_overlap(), r.overlay.agreement(),
      r.overlay.residual_m(), r.hold, r.rival, r.shared_m2, took_s, r.reason.c_str());
  std::fflush(stdout);
}

void same(const VoxelMap& a, const VoxelMap& b, int runs) {
  Random random(7);
  for (const double overlap : {0.2, 0.4, 0.6, 0.8}) {
    Tally tally;
    const double length = 1 / (2 - overlap);
    const MapPiece target = piece(cut(a, -1e9, quantile_x(a, length), {}));
    const double from_x = quantile_x(a, 1 - length);
    for (int i = 0; i < runs; ++i) {
      Quat turn = from_heading(random.uniform(-std::numbers::pi, std::numbers::pi));
      if (!options.coarse.gravity_known)
        turn = (turn * Quat(Eigen::AngleAxisd(random.uniform(0, 3.1), Vec3::UnitX()))).normalized();
      const Pose T_source_target{{random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-5, 5)},
                                 turn};
      const MapPiece source = piece(cut(b, from_x, 1e9, T_source_target));
      const Pose truth = T_source_target.inverse();
      char what[64];
      std::snprintf(what, sizeof what, "overlap %.0f %% run %d", 100 * overlap, i);
      run(what, target, source, &truth, tally);
    }
    char what[64];
    std::snprintf(what, sizeof what, "overlap %.0f %%", 100 * overlap);
    tally.print(what);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files;
  for (int i = 2; i < argc; ++i) {
    if (std::strcmp(argv[i], "--clouds") == 0) {
      clouds = true;
    } else if (std::strcmp(argv[i], "--six") == 0) {
      options.coarse.gravity_known = false;
    } else {
      files.emplace_back(argv[i]);
    }
  }
  if (argc < 2 || files.size() < 2) return std::puts("merge_campaign same|different A.bt B.bt ..."), 1;
  if (std::strcmp(argv[1], "same") == 0) {
    same(read_octomap(files[0]), read_octomap(files[1]), files.size() > 2 ? std::stoi(files[2]) : 10);
    return 0;
  }
  std::vector<MapPiece> pieces;
  for (const std::string& f : files) pieces.push_back(piece(read_octomap(f)));
  Tally tally;
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = 0; j < files.size(); ++j)
      if (i != j)
        run((std::to_string(i) + " <- " + std::to_string(j)).c_str(), pieces[i], pieces[j], nullptr, tally);
  tally.print("different");
}
