// Writes an MCAP file (https://mcap.dev/spec), version 0: messages in chunks, an index of each chunk, and a
// summary.
#pragma once
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace karst::mcap {

using ChannelId = std::uint16_t;

/// A topic and what its messages are.
struct ChannelInfo {
  std::string topic, message_encoding;
  std::string schema_name, schema_encoding, schema;
  std::map<std::string, std::string> metadata = {};
};

struct WriterOptions {
  std::string profile, library;
  std::size_t chunk_bytes = std::size_t{1} << 20;  // a chunk ends with the message that reaches them
};

/// Chunks are compressed by zstd: at its level 3 a flight's file is a quarter to a third smaller than with
/// lz4 (docs/results/mcap_export.md), and readers of MCAP know both.
class McapWriter {
 public:
  /// `out` is empty and outlives the writer. Nothing is thrown if it fails: see good().
  McapWriter(std::ostream& out, WriterOptions options);

  /// Channels of one schema share it. Throws std::length_error beyond 65535 channels.
  ChannelId add_channel(const ChannelInfo& info);
  /// In any order of time, though readers are quick if the times rise. `time_ns` since 1970.
  void write(ChannelId channel, std::uint64_t time_ns, std::string_view message);
  void metadata(const std::string& name, const std::map<std::string, std::string>& entries);
  /// The summary. Nothing can be added afterwards.
  void finish();

  /// Whether everything could be written so far.
  bool good() const { return out_.good(); }
  std::uint64_t messages() const { return messages_; }
  std::uint64_t bytes() const { return position_; }

 private:
  struct Schema {
    std::string record;
    bool written = false;
  };
  struct Channel {
    std::string record;
    std::uint16_t schema = 0;
    std::uint64_t messages = 0;
  };
  struct IndexEntry {
    std::uint64_t time_ns = 0, offset = 0;  // in the chunk before compression
  };

  void put(std::string_view bytes);
  void end_chunk();
  std::string statistics() const;

  std::ostream& out_;
  const WriterOptions options_;
  std::uint64_t position_ = 0;  // bytes written
  unsigned long crc_ = 0;       // of them
  std::vector<Schema> schemas_;
  std::map<std::string, std::uint16_t> schema_of_name_;  // numbers begin with 1
  std::vector<Channel> channels_;

  std::string chunk_;  // not yet compressed
  std::map<ChannelId, std::vector<IndexEntry>> chunk_index_;
  std::uint64_t chunk_begin_ns_ = 0, chunk_end_ns_ = 0;

  std::string chunk_indexes_, metadata_indexes_;  // records of the summary
  std::uint32_t chunks_ = 0, metadata_ = 0;
  std::uint64_t messages_ = 0, begin_ns_ = 0, end_ns_ = 0;
};

}  // namespace karst::mcap
