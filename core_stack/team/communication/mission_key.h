// The key that a team's frames are authenticated with: one for all of its radios, and one for each mission.
//
// The tag of a frame is the keyed BLAKE2b-128 of its bytes (RFC 7693), truncated to 64 bits. An attacker
// without the key forges a frame with probability 2^-64; a radio of 64 kbit/s carries some 10^9 frames a
// year. A tag cannot show which holder of the key wrote the frame; plausible.h limits the damage of that.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "core_stack/team/communication/wire.h"

namespace karst::core {

struct MissionKey {
  std::array<std::uint8_t, 32> bytes{};
};

/// For simulation only: every run directory holds the seed, and so gives away this key.
MissionKey key_of_seed(std::uint64_t seed);
/// Reads the key from a regular file that holds 64 hexadecimal digits and white space. Throws InputError
/// naming the file, never its content.
MissionKey read_key(const std::string& file);

constexpr std::size_t kTagBytes = 8;
using Tag = std::array<std::uint8_t, kTagBytes>;
Tag tag_of(std::span<const std::uint8_t> bytes, const MissionKey& key);
/// Runs in constant time, whichever byte differs.
bool has_tag(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> tag, const MissionKey& key);

}  // namespace karst::core
