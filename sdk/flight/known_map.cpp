#include "sdk/flight/known_map.h"

#include <sodium.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/mapping/octomap/octomap_io.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;
using core::InputError;

/// Of a run directory, its map: with log-odds if it is there, else with classes.
std::string map_file_of(const Mission& mission) {
  const std::string& start = mission.earlier.start;
  std::error_code ignored;
  if (!fs::exists(start, ignored)) throw InputError(mission.file, "map.start", start + " is not there");
  if (!fs::is_directory(start, ignored)) return start;
  for (const char* map : {"map.ot", "map.bt"})
    if (const fs::path file = fs::path(start) / map; fs::is_regular_file(file, ignored)) return file.string();
  throw InputError(start, "",
                   "holds no map.ot or map.bt; karst recover makes them of a flight that was cut off");
}

/// SHA-256, as sha256sum prints it.
std::string digest_of(const std::string& file) {
  std::ifstream in = core::open_input(file, core::kMaxDataFileBytes);
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  std::vector<char> block(1 << 20);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(block.data()),
                              static_cast<unsigned long long>(in.gcount()));
  if (in.bad()) throw InputError(file, "", "cannot be read");
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest;
  crypto_hash_sha256_final(&state, digest.data());
  std::array<char, 2 * crypto_hash_sha256_BYTES + 1> hex;
  return sodium_bin2hex(hex.data(), hex.size(), digest.data(), digest.size());
}

}  // namespace

Mission with_earlier_map(Mission mission) {
  if (mission.earlier.start.empty()) return mission;
  if (mission.core.team.robots > 1)
    throw InputError(mission.file, "map.start", "is for a single vehicle: a team takes no earlier map");
  const std::string file = map_file_of(mission);
  const std::string digest = digest_of(file);
  if (const std::string& said = mission.earlier.digest; !said.empty() && said != digest)
    throw InputError(mission.file, "map.start_digest",
                     "is " + said + ", and that of " + file + " is " + digest + ": the map is another one");
  mission.earlier.digest = digest;
  auto cells = std::make_shared<const core::VoxelMap>(core::read_octomap(file));
  try {
    mission.core.earlier.map = core::earlier_map_of(file, std::move(cells));
  } catch (const std::invalid_argument& e) {
    throw InputError(file, "", e.what());
  }
  return mission;
}

}  // namespace karst::flight
