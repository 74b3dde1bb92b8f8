// A message is a struct with a table of its fields in their order on the wire: by size, the largest first,
// then the extensions. Packing, unpacking and the message's checksum all come from that table. Source:
// https://mavlink.io/en/guide/serialization.html
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace karst::mavlink {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian, as this code");

/// `extension`: added to the message in MAVLink 2, not part of its checksum.
template <class Message, class T>
struct Field {
  std::string_view name;
  T Message::*member;
  bool extension;
};
template <class Message, class T>
constexpr Field<Message, T> field(std::string_view name, T Message::*member) {
  return {name, member, false};
}
template <class Message, class T>
constexpr Field<Message, T> extension(std::string_view name, T Message::*member) {
  return {name, member, true};
}

/// CRC-16/MCRF4XX, by which MAVLink checks its frames.
constexpr std::uint16_t crc_add(std::uint16_t crc, std::uint8_t byte) {
  std::uint8_t t = static_cast<std::uint8_t>(byte ^ (crc & 0xff));
  t = static_cast<std::uint8_t>(t ^ (t << 4));
  return static_cast<std::uint16_t>((crc >> 8) ^ (t << 8) ^ (t << 3) ^ (t >> 4));
}
constexpr std::uint16_t kCrcBegin = 0xffff;

namespace detail {

template <class T>
struct Element {
  using type = T;
  static constexpr std::size_t count = 0;  // no array
};
template <class T, std::size_t N>
struct Element<std::array<T, N>> {
  using type = T;
  static constexpr std::size_t count = N;
};

template <class T>
constexpr std::string_view type_name() {
  if constexpr (std::is_same_v<T, char>) return "char";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8_t";
  if constexpr (std::is_same_v<T, std::int8_t>) return "int8_t";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "uint16_t";
  if constexpr (std::is_same_v<T, std::int16_t>) return "int16_t";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32_t";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32_t";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "uint64_t";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64_t";
  if constexpr (std::is_same_v<T, float>) return "float";
}

constexpr std::uint16_t crc_of_text(std::uint16_t crc, std::string_view text) {
  for (const char c : text) crc = crc_add(crc, static_cast<std::uint8_t>(c));
  return crc_add(crc, ' ');
}

template <class Message, class T>
constexpr std::uint16_t crc_of_field(std::uint16_t crc, const Field<Message, T>& f) {
  if (f.extension) return crc;
  crc = crc_of_text(crc, type_name<typename Element<T>::type>());
  crc = crc_of_text(crc, f.name);
  if constexpr (Element<T>::count > 0) crc = crc_add(crc, static_cast<std::uint8_t>(Element<T>::count));
  return crc;
}

}  // namespace detail

/// The byte that a frame's checksum ends with, so that both sides agree on the message's fields.
template <class Message>
constexpr std::uint8_t crc_extra() {
  std::uint16_t crc = detail::crc_of_text(kCrcBegin, Message::kName);
  std::apply([&crc](const auto&... f) { ((crc = detail::crc_of_field(crc, f)), ...); }, Message::fields());
  return static_cast<std::uint8_t>((crc & 0xff) ^ (crc >> 8));
}

/// Bytes of all fields, extensions included.
template <class Message>
constexpr std::size_t payload_size() {
  return std::apply(
      [](const auto&... f) { return (sizeof(std::declval<Message>().*(f.member)) + ... + std::size_t{0}); },
      Message::fields());
}

/// Returns the bytes to send: zeros at the end are left off, except for the first byte.
template <class Message>
std::size_t pack(const Message& m, std::span<std::uint8_t> out) {
  std::size_t at = 0;
  std::apply(
      [&](const auto&... f) {
        ((std::memcpy(out.data() + at, &(m.*(f.member)), sizeof(m.*(f.member))), at += sizeof(m.*(f.member))),
         ...);
      },
      Message::fields());
  while (at > 1 && out[at - 1] == 0) --at;
  return at;
}

/// Fields that were left off are zero; what is longer than the message has fields added since.
template <class Message>
Message unpack(std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, 255> bytes{};
  std::memcpy(bytes.data(), payload.data(), std::min(payload.size(), bytes.size()));
  Message m;
  std::size_t at = 0;
  std::apply(
      [&](const auto&... f) {
        ((std::memcpy(&(m.*(f.member)), bytes.data() + at, sizeof(m.*(f.member))),
          at += sizeof(m.*(f.member))),
         ...);
      },
      Message::fields());
  return m;
}

}  // namespace karst::mavlink
