// Numbers in the bytes of a packet. Every sensor here sends them with the lowest byte first, unaligned.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace karst::lidar {

static_assert(std::endian::native == std::endian::little, "numbers are read as the machine has them");

using Packet = std::vector<std::uint8_t>;
using PacketView = std::span<const std::uint8_t>;

/// The number at `offset`, which must lie within the packet.
template <class T>
requires std::is_arithmetic_v<T> T load(PacketView packet, std::size_t offset) {
  T value;
  std::memcpy(&value, packet.data() + offset, sizeof value);
  return value;
}

template <class T>
requires std::is_arithmetic_v<T>
void store(Packet& packet, std::size_t offset, T value) {
  std::memcpy(packet.data() + offset, &value, sizeof value);
}

}  // namespace karst::lidar
