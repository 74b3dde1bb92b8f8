// What bags of chunks have in common, whatever the format of their records: MCAP and ROS 1.
#pragma once
#include <fstream>
#include <map>
#include <unordered_set>

#include "plugins/replay/bag/bag.h"
#include "plugins/replay/bag/chunk_merge.h"
#include "plugins/replay/bag/decompress.h"

namespace karst::replay {

/// Where a chunk's records are in the file, or messages that lie outside of chunks, one after another.
struct ChunkPlace {
  std::uint64_t record = 0;            // where its record begins
  std::uint64_t offset = 0, size = 0;  // of the stored bytes
  Compression compression = Compression::none;
  std::uint64_t bytes = 0;            // decompressed, as announced
  std::uint32_t crc = 0;              // of the decompressed bytes; 0: not known
  std::optional<core::TimeNs> start;  // of its first message; unknown in a bag without an index
  std::string_view cut;               // why only its beginning can be read; "" for an intact one
};

class ChunkedBag : public Bag {
 public:
  explicit ChunkedBag(const std::string& path);

  const std::vector<Connection>& connections() const override { return connections_; }
  void select(std::vector<bool> wanted) override { wanted_ = std::move(wanted); }
  core::TimeNs begin() const override;
  std::optional<BagMessage> next() override;
  const FaultLog& faults() const override { return faults_; }

 protected:
  /// Appends the messages among a chunk's records, and adds connections that are new. Throws MalformedError
  /// at the first record that is damaged; what was appended before it is used.
  virtual void parse(Bytes records, std::vector<ChunkMessage>& messages) = 0;

  /// Bytes of the file: fewer than `size` where it ends.
  std::string read_at(std::uint64_t offset, std::uint64_t size);
  std::uint64_t file_bytes() const { return file_bytes_; }
  const std::string& path() const { return path_; }
  void fault(std::uint64_t byte, const std::string& reason) {
    faults_.add("byte " + std::to_string(byte), reason);
  }
  /// What follows the reason of a fault at `byte`: where reading goes on, if anywhere.
  std::string skipped_text(std::uint64_t byte, std::optional<std::uint64_t> next) const;
  /// The number under which the format knows a connection, such as an MCAP channel's. The first description
  /// wins.
  void connect(std::uint32_t number, Connection connection);
  std::optional<std::size_t> connection_of(std::uint32_t number) const;

  void add_chunk(ChunkPlace place);
  /// True if a chunk's record begins there.
  bool knows_chunk_at(std::uint64_t record) const { return records_.contains(record); }
  /// Reads every chunk once whose start is not known, or all of them, for connections and start times.
  void rebuild_index(bool all);
  /// After the last chunk was added. Throws InputError if there is nothing to read.
  void finish_opening();

 private:
  LoadedChunk load(std::size_t chunk, bool log);
  /// The connections among the records of a damaged chunk.
  void take_descriptions(Bytes records);

  std::string path_;
  std::ifstream file_;
  std::uint64_t file_bytes_ = 0;
  std::vector<Connection> connections_;
  std::map<std::uint32_t, std::size_t> by_number_;
  std::vector<ChunkPlace> chunks_;
  std::unordered_set<std::uint64_t> records_;  // of these chunks
  std::vector<bool> wanted_;
  std::optional<ChunkMerge> merge_;
  FaultLog faults_;
};

}  // namespace karst::replay
