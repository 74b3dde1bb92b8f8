// The parts of which MCAP's records are made (https://mcap.dev/spec#serialization): numbers are
// little-endian.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "core_stack/common/little_endian.h"

namespace karst::mcap {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline void append_text(std::string& bytes, std::string_view text) {
  core::append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

inline void append_map(std::string& bytes, const std::map<std::string, std::string>& entries) {
  std::string pairs;
  for (const auto& [key, value] : entries) {
    append_text(pairs, key);
    append_text(pairs, value);
  }
  append_text(bytes, pairs);  // of that many bytes, not entries
}

/// Opcode, length and content.
inline void append_record(std::string& bytes, Opcode opcode, std::string_view content) {
  core::append_bytes(bytes, static_cast<std::uint8_t>(opcode));
  core::append_bytes(bytes, static_cast<std::uint64_t>(content.size()));
  bytes += content;
}

inline std::string record(Opcode opcode, std::string_view content) {
  std::string bytes;
  append_record(bytes, opcode, content);
  return bytes;
}

}  // namespace karst::mcap
