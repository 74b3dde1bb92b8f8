// Bags of ROS 1, format 2.0 (http://wiki.ros.org/Bags/Format/2.0): records of a header of named fields and
// data, each after its length as 32 bits.
#include "core_stack/common/error.h"
#include "plugins/replay/bag/chunked_bag.h"

namespace karst::replay {
namespace {

enum RosbagOpcode : std::uint8_t {
  kMessageData = 0x02,
  kBagHeader = 0x03,
  kIndexData = 0x04,
  kChunkData = 0x05,
  kChunkInfo = 0x06,
  kConnectionData = 0x07,
};
constexpr std::string_view kRosbagMagic = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMaxHeaderBytes = 1u << 20, kMaxConnectionBytes = 16u << 20;
constexpr std::uint64_t kChunkHeadBytes = 4096;  // of a chunk's header, with room to spare
constexpr std::size_t kMostChunkHeader = 200, kBeforeOp = 80;
constexpr std::uint64_t kLooseRunBytes = 4u << 20;

/// The named fields of a record's header.
class HeaderFields {
 public:
  explicit HeaderFields(Bytes header) {
    for (ByteCursor at(header); at.left() > 0;) {
      const std::size_t begin = at.at();
      const std::string_view field = at.take_text();
      const auto equals = field.find('=');
      if (equals == std::string_view::npos) throw MalformedError("a header's field has no name", begin);
      fields_.emplace(field.substr(0, equals), field.substr(equals + 1));
    }
  }
  bool has(std::string_view name) const { return fields_.contains(name); }
  std::string_view text(std::string_view name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) throw MalformedError("a record without the field " + std::string(name), 0);
    return found->second;
  }
  template <class T>
  T number(std::string_view name) const {
    const std::string_view value = text(name);
    if (value.size() != sizeof(T))
      throw MalformedError("the field " + std::string(name) + " has another length", 0);
    return ByteCursor(Bytes(value.data(), value.size())).take<T>();
  }
  core::TimeNs time(std::string_view name) const {
    const auto both = number<std::uint64_t>(name);  // seconds, then nanoseconds
    return static_cast<core::TimeNs>(both & 0xffffffff) * core::kSecond +
           static_cast<core::TimeNs>(both >> 32);
  }

 private:
  std::map<std::string_view, std::string_view> fields_;
};

class Rosbag1 final : public ChunkedBag {
 public:
  explicit Rosbag1(const std::string& path) : ChunkedBag(path) {
    const bool whole = find_records(kRosbagMagic.size());
    // Without the index at the end, connections and times stand in the chunks only.
    rebuild_index(!whole || connections().empty());
    finish_opening();
  }

 private:
  void parse(Bytes records, std::vector<ChunkMessage>& messages) override {
    for (ByteCursor at(records); at.left() > 0;) {
      const std::size_t begin = at.at();
      const HeaderFields fields(at.take_counted());
      const Bytes data = at.take_counted();
      const auto opcode = fields.number<std::uint8_t>("op");
      if (opcode == kChunkData) throw MalformedError("a chunk begins inside of the chunk", begin);
      if (opcode == kConnectionData) take_connection(fields, data);
      if (opcode != kMessageData) continue;
      const auto number = fields.number<std::uint32_t>("conn");
      const auto connection = connection_of(number);
      if (!connection)
        throw MalformedError(
            "a message of the connection " + std::to_string(number) + ", which is not described", begin);
      messages.push_back({fields.time("time"), *connection, at.at() - data.size(), data.size()});
    }
  }

  void take_connection(const HeaderFields& record, Bytes data) {
    const HeaderFields fields(data);
    Connection c;
    c.topic = record.text("topic");
    c.type = fields.text("type");
    c.encoding = Encoding::ros1;
    if (fields.has("message_definition")) c.definition = fields.text("message_definition");
    connect(record.number<std::uint32_t>("conn"), std::move(c));
  }

  /// Goes from record to record, and behind damage from the next chunk on. False where the file is damaged or
  /// cut, or has no index.
  bool find_records(std::uint64_t offset) {
    std::uint64_t index = 0;  // where the header says that it begins
    for (bool whole = true;; whole = false) {
      std::uint64_t last = offset, last_chunk = 0;
      const std::string problem = walk(offset, last, last_chunk, index);
      if (problem.empty()) {
        if (whole && index != 0 && index < file_bytes()) {
          use_index(index, whole);
          return true;
        }
        if (whole) fault(file_bytes(), "the bag has no index: it was not closed, or is cut");
        return false;
      }
      // The length of the last record may be what is wrong.
      const auto next = next_chunk(last + 1);
      fault(offset, problem + (next || !ends_cut_ ? skipped_text(offset, next) : ""));
      if (!next) {
        if (index > last_chunk && index < file_bytes()) use_index(index, false);
        return false;
      }
      offset = *next;
    }
  }

  /// To the end of the file; else why it ends at `offset`. `last`: where the record before that begins.
  std::string walk(std::uint64_t& offset, std::uint64_t& last, std::uint64_t& last_chunk,
                   std::uint64_t& index) {
    std::optional<ChunkPlace> loose, chunk;
    const auto end_chunk = [&] {
      for (auto* place : {&loose, &chunk})
        if (*place) add_chunk(**place);
      loose.reset();
      chunk.reset();
    };
    ends_cut_ = false;
    try {
      while (offset < file_bytes()) {
        const std::string lengths = read_at(offset, 4);
        const auto header_bytes = ByteCursor{Bytes(lengths)}.take<std::uint32_t>();
        if (header_bytes > kMaxHeaderBytes) throw MalformedError("no record begins here", 0);
        const std::string header = read_at(offset + 4, std::uint64_t{header_bytes} + 4);
        ByteCursor at{Bytes(header)};
        const HeaderFields fields(at.take_bytes(header_bytes));
        const std::uint64_t size = at.take<std::uint32_t>(), begin = offset + 8 + header_bytes,
                            left = file_bytes() - begin;
        const auto opcode = fields.number<std::uint8_t>("op");
        if (opcode == kMessageData || (opcode == kConnectionData && loose)) {
          // What stands outside of a chunk is of a chunk whose length was never written.
          if (!loose) {
            end_chunk();
            loose = ChunkPlace{offset, offset, 0, Compression::none, 0, 0, std::nullopt, ""};
          }
          loose->bytes = loose->size = std::min(begin + size, file_bytes()) - loose->offset;
          if (loose->size >= kLooseRunBytes) end_chunk();
        } else if (opcode == kIndexData && chunk) {
          note_start(fields, read_at(begin, std::min<std::uint64_t>(size, 12)), *chunk);
        } else {
          end_chunk();
        }
        if (opcode == kBagHeader) index = fields.number<std::uint64_t>("index_pos");
        if (opcode == kChunkData) {
          last_chunk = begin;
          chunk = chunk_of(fields, offset, begin, size, left);
        }
        if (opcode == kConnectionData && size <= std::min<std::uint64_t>(left, kMaxConnectionBytes)) {
          const std::string data = read_at(begin, size);
          take_connection(fields, Bytes(data));
        }
        if (size > left) {
          ends_cut_ = chunk.has_value() || loose.has_value();
          throw MalformedError("the file ends within a record: " + std::to_string(size) +
                                   " bytes are announced, " + std::to_string(left) + " are left",
                               0);
        }
        last = offset;
        offset = begin + size;
      }
      end_chunk();
      return "";
    } catch (const MalformedError& e) {
      if (chunk && chunk->size == 0 && offset == chunk->offset) {
        // A chunk that was being written: its length is not known yet.
        chunk->size = file_bytes() - offset;
        chunk->cut = "it was not closed";
        ends_cut_ = true;
      }
      end_chunk();
      return e.what();
    }
  }

  /// The first byte from `from` on where a chunk's record begins.
  std::optional<std::uint64_t> next_chunk(std::uint64_t from) {
    constexpr std::uint64_t kWindow = 1u << 20;
    constexpr std::string_view kOp("\4\0\0\0op=\5", 8);  // a field of its header, the first or a later one
    for (; from < file_bytes(); from += kWindow) {
      const std::string window = read_at(from, kWindow + kChunkHeadBytes);
      for (std::size_t op = window.find(kOp); op != std::string::npos; op = window.find(kOp, op + 1)) {
        const std::size_t first = op < kBeforeOp ? 0 : op - kBeforeOp;
        for (std::size_t at = first; at + 4 <= op; ++at)
          if (begins_chunk(Bytes(window).subspan(at), file_bytes() - from - at)) return from + at;
      }
    }
    return std::nullopt;
  }

  /// Whether these bytes, of so many that are left in the file, begin with an intact chunk's header.
  static bool begins_chunk(Bytes bytes, std::uint64_t left) try {
    ByteCursor at(bytes);
    const auto header_bytes = at.take<std::uint32_t>();
    if (header_bytes > kMostChunkHeader) return false;
    const HeaderFields fields(at.take_bytes(header_bytes));
    if (fields.number<std::uint8_t>("op") != kChunkData || !fields.has("size")) return false;
    const auto compression = core::parse<Compression>(fields.text("compression"));
    const auto size = at.take<std::uint32_t>();
    return compression && size > 0 && at.at() + size <= left;
  } catch (const MalformedError&) {
    return false;
  }

  std::optional<ChunkPlace> chunk_of(const HeaderFields& fields, std::uint64_t record, std::uint64_t begin,
                                     std::uint64_t size, std::uint64_t left) {
    const std::string_view name = fields.text("compression");
    const auto compression = core::parse<Compression>(name);
    if (!compression || *compression == Compression::zstd) {
      fault(record, "a chunk is compressed by \"" + std::string(name.substr(0, 20)) +
                        "\", which is none of none, bz2 and lz4");
      return std::nullopt;
    }
    ChunkPlace place{record, begin,        size, *compression, fields.number<std::uint32_t>("size"),
                     0,      std::nullopt, ""};
    if (size > left) place.cut = "it is cut";
    if (size == 0 && place.bytes == 0) place.cut = "it was not closed";
    return place;
  }

  /// Entries of one connection, in the order of time: time and offset of each message.
  static void note_start(const HeaderFields& fields, const std::string& first_entry, ChunkPlace& chunk) {
    if (fields.number<std::uint32_t>("ver") != 1 || first_entry.size() < 12) return;
    ByteCursor at{Bytes(first_entry)};
    const core::TimeNs s = at.take<std::uint32_t>(), ns = at.take<std::uint32_t>(),
                       time = s * core::kSecond + ns;
    chunk.start = std::min(chunk.start.value_or(time), time);
  }

  /// Chunks that only the index at the end of the file tells of: a record before them has a
  /// wrong length. Behind a piece that is missing its offsets are wrong: of a file that is not whole, that is
  /// no further fault.
  void use_index(std::uint64_t index, bool whole) try {
    if (file_bytes() - index > kMaxChunkBytes) return;
    const std::string records = read_at(index, file_bytes() - index);
    for (ByteCursor at{Bytes(records)}; at.left() > 0;) {
      const HeaderFields fields(at.take_counted());
      const Bytes data = at.take_counted();
      const auto opcode = fields.number<std::uint8_t>("op");
      if (opcode == kConnectionData) take_connection(fields, data);
      if (opcode != kChunkInfo) continue;
      const auto position = fields.number<std::uint64_t>("chunk_pos");
      if (position >= index || knows_chunk_at(position)) continue;
      if (auto place = chunk_at(position)) {
        place->start = fields.time("start_time");
        add_chunk(*place);
      }
    }
  } catch (const MalformedError& e) {
    if (whole) fault(index, std::string("the index: ") + e.what());
  }

  /// nullopt if the index is wrong, and no chunk begins there.
  std::optional<ChunkPlace> chunk_at(std::uint64_t position) try {
    const std::string head = read_at(position, kChunkHeadBytes);
    ByteCursor at{Bytes(head)};
    const HeaderFields fields(at.take_counted());
    if (fields.number<std::uint8_t>("op") != kChunkData) return std::nullopt;
    const auto size = at.take<std::uint32_t>();
    const std::uint64_t begin = position + at.at();
    return chunk_of(fields, position, begin, size, file_bytes() - begin);
  } catch (const MalformedError&) {
    return std::nullopt;
  }

  bool ends_cut_ = false;  // within a chunk, whose beginning is read
};

}  // namespace

std::unique_ptr<Bag> open_rosbag1(const std::string& path) { return std::make_unique<Rosbag1>(path); }

}  // namespace karst::replay
