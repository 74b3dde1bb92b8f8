// Several packets out of one input: each behind its length, of 16 bits. The last may be shorter than it says.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace karst::fuzz {

inline std::vector<std::span<const std::uint8_t>> packets_of(const std::uint8_t* data, std::size_t size) {
  std::vector<std::span<const std::uint8_t>> packets;
  for (std::size_t at = 0; at + 2 <= size;) {
    const std::size_t says = data[at] | static_cast<std::size_t>(data[at + 1]) << 8;
    const std::size_t length = std::min(says, size - at - 2);
    packets.emplace_back(data + at + 2, length);
    at += 2 + length;
  }
  return packets;
}

}  // namespace karst::fuzz
