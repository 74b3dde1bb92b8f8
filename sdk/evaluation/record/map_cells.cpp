#include "sdk/evaluation/record/map_cells.h"

#include <cmath>
#include <string_view>
#include <unordered_map>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/mission/recording/map_cells.h"

namespace karst::evaluation {
namespace {

float log_odds_of(double probability) {
  return static_cast<float>(std::log(probability / (1 - probability)));
}

}  // namespace

std::optional<core::VoxelMap> read_map_cells(const std::filesystem::path& file, double resolution_m,
                                             std::vector<std::string>& problems) {
  constexpr std::size_t kBytes = core::MapCellRecord::kBytes;
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return std::nullopt;
  std::string bytes;
  try {
    bytes = core::read_input(file, core::kMaxRecordFileBytes);
  } catch (const core::InputError& e) {
    problems.emplace_back(e.what());
    return std::nullopt;
  }
  const std::string name = file.filename().string();
  if (bytes.size() % kBytes != 0)
    problems.push_back(name + ": byte " + std::to_string(bytes.size() / kBytes * kBytes) +
                       ": a record is cut off; only those before it are used");
  std::unordered_map<core::CellKey, core::Cell, core::CellKeyHash> last;
  std::size_t damaged = 0;
  for (std::size_t i = 0; i + kBytes <= bytes.size(); i += kBytes) {
    const auto record = core::map_cell_of(std::string_view(bytes).substr(i, kBytes));
    damaged += !record;
    if (record) last[record->key] = record->cell;
  }
  if (damaged > 0)
    problems.push_back(name + ": " + std::to_string(damaged) +
                       " records are damaged, such as zeros; left out");
  core::MapOptions options;
  options.resolution_m = resolution_m;
  core::VoxelMap map(options);
  bool known = false;
  for (const auto& [key, cell] : last) {  // in any order: each cell comes once
    if (cell == core::Cell::unknown) continue;
    map.assign(key, 1,
               log_odds_of(cell == core::Cell::occupied ? options.max_probability : options.min_probability));
    known = true;
  }
  if (!known) return std::nullopt;
  return map;
}

}  // namespace karst::evaluation
