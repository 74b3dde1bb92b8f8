// A run directory whose flight was cut off, by a power cut or a kill: what can be made of what was kept.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace karst::flight {

/// Whether the flight came to its end and everything was made of it: there is nothing to recover. The report
/// is made only if it is asked for, and does not count.
bool is_whole(const std::filesystem::path& run_dir);

struct RecoveredMap {
  std::vector<std::filesystem::path> written;
  std::vector<std::string> notes;  // what is missing, and what was left out
};

/// Writes map.bt, map.ot and map.ply of map_cells.bin, or map.ply alone of map_growth.bin, unless there is a
/// map that can be read. Changes no other file but run.lock, which it removes. Throws core::InputError if a
/// flight still writes there, for a team, and if a file cannot be written.
RecoveredMap recover_map(const std::filesystem::path& run_dir);

}  // namespace karst::flight
