// Writes bags of ROS 1, MCAP and db3 in all their variants, from the formats' documentation.
#pragma once
#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <vector>

#include "core_stack/common/time.h"
#include "plugins/replay/bag/decompress.h"
#include "tests/unit/replay/folder.h"

namespace karst::test {

/// Serializes as ROS 1 does, or as CDR of either byte order.
class Serializer {
 public:
  enum Kind { ros1, cdr_little, cdr_big };
  explicit Serializer(Kind kind) : kind_(kind) {
    if (kind != ros1) bytes_ = std::string(kind == cdr_little ? "\0\1\0\0" : "\0\0\0\0", 4);
  }
  template <class T>
  Serializer& number(T value) {
    if (kind_ != ros1)
      while ((bytes_.size() - 4) % sizeof value != 0) bytes_ += '\0';
    auto* raw = reinterpret_cast<char*>(&value);
    if (kind_ == cdr_big) std::reverse(raw, raw + sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  Serializer& text(const std::string& t) {
    number(static_cast<std::uint32_t>(t.size() + (kind_ != ros1)));
    bytes_ += t;
    if (kind_ != ros1) bytes_ += '\0';
    return *this;
  }
  Serializer& blob(const std::string& t) {
    number(static_cast<std::uint32_t>(t.size()));
    bytes_ += t;
    return *this;
  }
  Serializer& header(core::TimeNs stamp, const std::string& frame) {
    if (kind_ == ros1) number(std::uint32_t{7});
    number(static_cast<std::uint32_t>(stamp / core::kSecond));
    number(static_cast<std::uint32_t>(stamp % core::kSecond));
    return text(frame);
  }
  Kind kind() const { return kind_; }
  const std::string& bytes() const { return bytes_; }

 private:
  Kind kind_;
  std::string bytes_;
};

struct PointFieldSpec {
  std::string name;
  std::uint32_t offset;
  std::uint8_t datatype;  // 1 int8, 2 uint8, ... 7 float32, 8 float64
};

inline std::string point_cloud2(Serializer::Kind kind, core::TimeNs stamp, const std::string& frame,
                                const std::vector<PointFieldSpec>& fields, std::uint32_t step,
                                const std::string& data) {
  Serializer s(kind);
  s.header(stamp, frame);
  const auto count = static_cast<std::uint32_t>(data.size() / step);
  s.number(std::uint32_t{1}).number(count).number(static_cast<std::uint32_t>(fields.size()));
  for (const auto& f : fields) s.text(f.name).number(f.offset).number(f.datatype).number(std::uint32_t{1});
  s.number(std::uint8_t{0}).number(step).number(count * step).blob(data).number(std::uint8_t{1});
  return s.bytes();
}

inline std::string imu(Serializer::Kind kind, core::TimeNs stamp, const std::string& frame,
                       const std::array<double, 3>& force, const std::array<double, 3>& rate) {
  Serializer s(kind);
  s.header(stamp, frame);
  for (const double q : {0.0, 0.0, 0.0, 1.0}) s.number(q);
  for (int i = 0; i < 9; ++i) s.number(0.0);
  for (const double v : rate) s.number(v);
  for (int i = 0; i < 9; ++i) s.number(0.0);
  for (const double v : force) s.number(v);
  for (int i = 0; i < 9; ++i) s.number(0.0);
  return s.bytes();
}

struct WrittenTopic {
  std::string topic, type, definition;  // type: package/Name
};
struct WrittenMessage {
  std::size_t topic;
  core::TimeNs time;
  std::string bytes;
};
struct BagVariant {
  replay::Compression compression = replay::Compression::none;
  bool index = true;
  std::size_t messages_in_chunk = 20;  // 0: no chunks (MCAP)
};

inline std::string compressed(replay::Compression c, const std::string& in) {
  if (c == replay::Compression::none) return in;
  std::string out(2 * in.size() + 4096, '\0');
  if (c == replay::Compression::bz2) {
    auto n = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &n, const_cast<char*>(in.data()), static_cast<unsigned>(in.size()),
                             9, 0, 0);
    out.resize(n);
  } else if (c == replay::Compression::lz4) {
    LZ4F_preferences_t preferences{};  // what ROS 1 writes, and reads
    preferences.frameInfo.blockMode = LZ4F_blockIndependent;
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    out.resize(LZ4F_compressFrame(out.data(), out.size(), in.data(), in.size(), &preferences));
  } else {
    out.resize(ZSTD_compress(out.data(), out.size(), in.data(), in.size(), 1));
  }
  return out;
}

namespace rosbag1 {
inline std::string field(const std::string& name, const std::string& value) {
  std::string s;
  put(s, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  return s + name + "=" + value;
}
inline std::string field(const std::string& name, const char* value) {
  return field(name, std::string(value));
}
template <class T>
std::string field(const std::string& name, T value) {
  std::string raw;
  put(raw, value);
  return field(name, raw);
}
inline std::string time(core::TimeNs t) {
  std::string raw;
  put(raw, static_cast<std::uint32_t>(t / core::kSecond));
  put(raw, static_cast<std::uint32_t>(t % core::kSecond));
  return raw;
}
inline std::string record(const std::string& header, const std::string& data) {
  std::string s;
  put(s, static_cast<std::uint32_t>(header.size()));
  s += header;
  put(s, static_cast<std::uint32_t>(data.size()));
  return s + data;
}
}  // namespace rosbag1

inline std::string ros1_bag(const std::vector<WrittenTopic>& topics,
                            const std::vector<WrittenMessage>& messages, const BagVariant& variant) {
  using namespace rosbag1;
  const auto connection = [&](std::size_t i) {
    const auto number = static_cast<std::uint32_t>(i);
    return record(field("op", std::uint8_t{7}) + field("conn", number) + field("topic", topics[i].topic),
                  field("topic", topics[i].topic) + field("type", topics[i].type) + field("md5sum", "*") +
                      field("message_definition", topics[i].definition));
  };
  const auto header = [&](std::uint64_t index, std::uint32_t chunks) {
    const std::string h = field("op", std::uint8_t{3}) + field("index_pos", index) +
                          field("conn_count", static_cast<std::uint32_t>(topics.size())) +
                          field("chunk_count", chunks);
    return "#ROSBAG V2.0\n" + record(h, std::string(4096 - 8 - h.size(), ' '));
  };
  std::string file = header(0, 0), infos;
  std::uint32_t chunks = 0;
  std::vector<bool> described(topics.size());
  for (std::size_t i = 0; i < messages.size(); i += variant.messages_in_chunk, ++chunks) {
    std::string chunk;
    std::map<std::size_t, std::string> entries;
    core::TimeNs first = messages[i].time, last = first;
    for (std::size_t j = i; j < std::min(messages.size(), i + variant.messages_in_chunk); ++j) {
      const auto& m = messages[j];
      if (!described[m.topic]) chunk += connection(m.topic);
      described[m.topic] = true;
      std::string& e = entries[m.topic];
      e += time(m.time);
      put(e, static_cast<std::uint32_t>(chunk.size()));
      chunk += record(field("op", std::uint8_t{2}) + field("conn", static_cast<std::uint32_t>(m.topic)) +
                          field("time", time(m.time)),
                      m.bytes);
      first = std::min(first, m.time), last = std::max(last, m.time);
    }
    const std::uint64_t position = file.size();
    file += record(field("op", std::uint8_t{5}) + field("compression", core::name_of(variant.compression)) +
                       field("size", static_cast<std::uint32_t>(chunk.size())),
                   compressed(variant.compression, chunk));
    std::string counts;
    for (const auto& [topic, e] : entries) {
      const auto count = static_cast<std::uint32_t>(e.size() / 12);
      if (variant.index)
        file += record(field("op", std::uint8_t{4}) + field("ver", std::uint32_t{1}) +
                           field("conn", static_cast<std::uint32_t>(topic)) + field("count", count),
                       e);
      put(counts, static_cast<std::uint32_t>(topic));
      put(counts, count);
    }
    infos +=
        record(field("op", std::uint8_t{6}) + field("ver", std::uint32_t{1}) + field("chunk_pos", position) +
                   field("start_time", time(first)) + field("end_time", time(last)) +
                   field("count", static_cast<std::uint32_t>(entries.size())),
               counts);
  }
  if (!variant.index) return file;
  const std::uint64_t index = file.size();
  for (std::size_t i = 0; i < topics.size(); ++i) file += connection(i);
  file += infos;
  return file.replace(0, header(index, chunks).size(), header(index, chunks));
}

namespace mcap {
inline std::string record(std::uint8_t opcode, const std::string& body) {
  std::string s(1, static_cast<char>(opcode));
  put(s, static_cast<std::uint64_t>(body.size()));
  return s + body;
}
inline std::string text(const std::string& t) {
  std::string s;
  put(s, static_cast<std::uint32_t>(t.size()));
  return s + t;
}
}  // namespace mcap

inline std::string mcap_file(const std::vector<WrittenTopic>& topics,
                             const std::vector<WrittenMessage>& messages, const BagVariant& variant) {
  using namespace mcap;
  std::string descriptions;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(i + 1);
    const auto slash = topics[i].type.find('/');
    std::string schema, channel;
    put(schema, id);
    schema += text(topics[i].type.substr(0, slash) + "/msg" + topics[i].type.substr(slash)) +
              text("ros2msg") + text(topics[i].definition);
    put(channel, id);
    put(channel, id);
    channel += text(topics[i].topic) + text("cdr");
    put(channel, std::uint32_t{0});
    descriptions += record(3, schema) + record(4, channel);
  }
  const auto message = [](const WrittenMessage& m) {
    std::string s;
    put(s, static_cast<std::uint16_t>(m.topic + 1));
    put(s, std::uint32_t{0});
    put(s, static_cast<std::uint64_t>(m.time));
    put(s, static_cast<std::uint64_t>(m.time));
    return record(5, s + m.bytes);
  };
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string file = magic + record(1, text("ros2") + text("test")), indexes;
  if (variant.messages_in_chunk == 0) {
    file += descriptions;
    for (const auto& m : messages) file += message(m);
  }
  for (std::size_t i = 0; variant.messages_in_chunk > 0 && i < messages.size();
       i += variant.messages_in_chunk) {
    std::string chunk = i == 0 ? descriptions : "", body, index;
    core::TimeNs first = messages[i].time, last = first;
    for (std::size_t j = i; j < std::min(messages.size(), i + variant.messages_in_chunk); ++j) {
      chunk += message(messages[j]);
      first = std::min(first, messages[j].time), last = std::max(last, messages[j].time);
    }
    put(body, static_cast<std::uint64_t>(first));
    put(body, static_cast<std::uint64_t>(last));
    put(body, static_cast<std::uint64_t>(chunk.size()));
    put(body, static_cast<std::uint32_t>(
                  crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size()))));
    const std::string stored = compressed(variant.compression, chunk);
    body += text(variant.compression == replay::Compression::none ? "" : core::name_of(variant.compression));
    put(body, static_cast<std::uint64_t>(stored.size()));
    body += stored;
    put(index, static_cast<std::uint64_t>(first));
    put(index, static_cast<std::uint64_t>(last));
    put(index, static_cast<std::uint64_t>(file.size()));
    put(index, static_cast<std::uint64_t>(body.size() + 9));
    indexes += record(8, index + std::string(4 + 8 + 4 + 16, '\0'));
    file += record(6, body);
  }
  file += record(15, std::string(4, '\0'));
  std::string footer;
  put(footer, static_cast<std::uint64_t>(variant.index ? file.size() : 0));
  if (variant.index) file += descriptions + indexes;
  return file + record(2, footer + std::string(12, '\0')) + magic;
}

inline void write_db3(const std::string& path, const std::vector<WrittenTopic>& topics,
                      const std::vector<WrittenMessage>& messages, bool index) {
  sqlite3* db = nullptr;
  sqlite3_open(path.c_str(), &db);
  const auto run = [&](const std::string& sql) { sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr); };
  run("BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB NOT NULL)");
  if (index) run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const auto slash = topics[i].type.find('/');
    run("INSERT INTO topics VALUES(" + std::to_string(i + 1) + ", '" + topics[i].topic + "', '" +
        topics[i].type.substr(0, slash) + "/msg" + topics[i].type.substr(slash) + "', 'cdr', '')");
  }
  for (const auto& m : messages) {
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(db, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)", -1, &insert,
                       nullptr);
    sqlite3_bind_int64(insert, 1, static_cast<sqlite3_int64>(m.topic + 1));
    sqlite3_bind_int64(insert, 2, m.time);
    sqlite3_bind_blob(insert, 3, m.bytes.data(), static_cast<int>(m.bytes.size()), nullptr);
    sqlite3_step(insert);
    sqlite3_finalize(insert);
  }
  run("COMMIT");
  sqlite3_close(db);
}

}  // namespace karst::test
