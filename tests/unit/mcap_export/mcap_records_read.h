// Reads the records of an MCAP file, for tests: written from the specification, apart from the writer.
#pragma once
#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace karst::test {

/// Takes numbers and texts off the front.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  T number() {
    T value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() { return std::string(take(number<std::uint32_t>())); }
  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("a record is too short");
    const std::string_view out = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return out;
  }
  bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

struct McapRecord {
  int opcode = 0;
  std::uint64_t offset = 0, length = 0;  // of the whole record in what it was read from
  std::string_view content;
};

inline std::vector<McapRecord> records_of(std::string_view bytes) {
  std::vector<McapRecord> out;
  for (std::size_t at = 0; at < bytes.size();) {
    Cursor head(bytes.substr(at));
    const int opcode = head.number<std::uint8_t>();
    const auto size = head.number<std::uint64_t>();
    out.push_back({opcode, at, 9 + size, head.take(size)});
    at += 9 + size;
  }
  return out;
}

constexpr std::size_t kMcapMagicBytes = 8;

/// Of a whole file. Offsets count from the file's begin.
inline std::vector<McapRecord> file_records(std::string_view file) {
  std::vector<McapRecord> out = records_of(file.substr(kMcapMagicBytes, file.size() - 2 * kMcapMagicBytes));
  for (McapRecord& r : out) r.offset += kMcapMagicBytes;
  return out;
}

struct McapChunk {
  std::uint64_t begin_ns = 0, end_ns = 0;
  std::uint32_t crc = 0;
  std::string compression, records;  // unpacked
};

inline McapChunk chunk_of(std::string_view content) {
  Cursor c(content);
  McapChunk out;
  out.begin_ns = c.number<std::uint64_t>();
  out.end_ns = c.number<std::uint64_t>();
  out.records.resize(c.number<std::uint64_t>());
  out.crc = c.number<std::uint32_t>();
  out.compression = c.text();
  const std::string_view packed = c.take(c.number<std::uint64_t>());
  const std::size_t size =
      ZSTD_decompress(out.records.data(), out.records.size(), packed.data(), packed.size());
  if (size != out.records.size()) throw std::runtime_error("a chunk cannot be unpacked");
  return out;
}

struct McapMessage {
  std::string topic, schema;
  std::uint32_t sequence = 0;
  std::uint64_t time_ns = 0;
  std::string data;
};

/// All messages, in the file's order.
inline std::vector<McapMessage> messages_of(std::string_view file) {
  std::vector<McapMessage> out;
  std::map<std::uint16_t, std::string> schemas, topics;
  std::map<std::uint16_t, std::uint16_t> schema_of;
  for (const McapRecord& r : file_records(file)) {
    if (r.opcode != 0x06) continue;
    const McapChunk chunk = chunk_of(r.content);
    for (const McapRecord& inside : records_of(chunk.records)) {
      Cursor c(inside.content);
      const auto id = c.number<std::uint16_t>();
      if (inside.opcode == 0x03) schemas[id] = c.text();
      if (inside.opcode == 0x04) {
        schema_of[id] = c.number<std::uint16_t>();
        topics[id] = c.text();
      }
      if (inside.opcode != 0x05) continue;
      McapMessage m;
      m.topic = topics.at(id);
      m.schema = schemas.at(schema_of.at(id));
      m.sequence = c.number<std::uint32_t>();
      m.time_ns = c.number<std::uint64_t>();
      c.number<std::uint64_t>();
      while (!c.empty()) m.data += c.take(1);
      out.push_back(std::move(m));
    }
  }
  return out;
}

}  // namespace karst::test
