// Maps to merge: reading, merging, writing.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sdk/map_merge/map_registration.h"

namespace karst::map_merge {

struct MapInput {
  std::string name, file;  // name on the command line, and the file that was read
  MapPiece piece;
};

/// Reads a run directory (its map.ot, map.bt or map.ply), a .bt or .ot file, or a cloud (.ply, .pcd, .bin),
/// which is thinned to `resolution_m`. Throws InputError.
MapInput read_map_input(const std::string& name, double resolution_m);

/// All maps so far, in the frame of the first.
class MergedMap {
 public:
  explicit MergedMap(const MapInput& first);
  void add(const MapInput& map, const core::Pose& T_first_map);
  const MapPiece& piece() const { return piece_; }
  /// Writes STEM.ot, STEM.bt and STEM.ply; only STEM.ply if any of the maps was a cloud. Writes all files or,
  /// with an InputError, none.
  std::vector<std::filesystem::path> write(const std::string& stem) const;

 private:
  MapPiece piece_;
};

}  // namespace karst::map_merge
