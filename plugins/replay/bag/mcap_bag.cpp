// MCAP (https://mcap.dev/spec): records of an opcode, a length as 64 bits, and so many bytes.
#include <limits>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/chunked_bag.h"

namespace karst::replay {
namespace {

enum McapOpcode : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kChunkIndex = 0x08,
  kMetadata = 0x0C,
};
constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
constexpr std::uint64_t kHead = 9;                    // of a record: opcode and length
constexpr std::uint64_t kFooterBytes = kHead + 20;    // the last record, before the last magic
constexpr std::uint64_t kMaxDescription = 16u << 20;  // a schema or channel that is larger is refused
constexpr std::uint64_t kLooseBytes = 4u << 20;       // messages outside chunks are read so many at a time
constexpr std::uint64_t kChunkHead = kHead + 40;      // without the name of its compression
constexpr std::uint64_t kMaxName = 4;                 // "zstd"
constexpr std::uint64_t kMaxMcapTime = std::numeric_limits<std::int64_t>::max();

std::string_view text_of(Bytes b) { return {b.data(), b.size()}; }

class McapBag final : public ChunkedBag {
 public:
  explicit McapBag(const std::string& path) : ChunkedBag(path) {
    if (read_at(0, kMcapMagic.size()) != kMcapMagic)
      throw core::InputError(path, "byte 0", "is no MCAP file of version 0");
    const bool whole = find_records(kMcapMagic.size());
    // Channels of a bag without a summary stand in its chunks.
    rebuild_index(!whole || !has_summary_);
    finish_opening();
  }

  RecordedSettings recorded_settings() const override { return settings_; }

 private:
  struct Schema {
    std::string name, encoding, text;
  };

  void parse(Bytes records, std::vector<ChunkMessage>& messages) override {
    ByteCursor at(records);
    while (at.left() > 0) {
      const std::size_t begin = at.at();
      const auto opcode = at.take<std::uint8_t>();
      const auto length = at.take<std::uint64_t>();
      const Bytes record = at.take_bytes(length);
      if (opcode == kChunk) throw MalformedError("a chunk begins inside of the chunk", begin);
      if (opcode == kMessage) {
        take_message(record, begin + kHead, messages);
      } else {
        take_description(opcode, record);
      }
    }
  }

  void take_message(Bytes record, std::size_t begin, std::vector<ChunkMessage>& messages) {
    ByteCursor at(record);
    const auto channel = at.take<std::uint16_t>();
    at.take<std::uint32_t>();  // sequence
    const auto time = at.take<std::uint64_t>();
    at.take<std::uint64_t>();  // publish time
    const auto connection = connection_of(channel);
    if (!connection)
      throw MalformedError("a message of the channel " + std::to_string(channel) + ", which is not described",
                           begin);
    if (time > kMaxMcapTime) throw MalformedError("a message's time is after the year 2262", begin);
    messages.push_back({static_cast<core::TimeNs>(time), *connection, begin + at.at(), at.left()});
  }

  void take_description(std::uint8_t opcode, Bytes record) {
    ByteCursor at(record);
    if (opcode == kSchema) {
      const auto id = at.take<std::uint16_t>();
      Schema schema;
      schema.name = at.take_text();
      schema.encoding = at.take_text();
      schema.text = text_of(at.take_counted());
      schemas_.emplace(id, std::move(schema));
    } else if (opcode == kChannel) {
      const auto id = at.take<std::uint16_t>();
      const auto schema = schemas_.find(at.take<std::uint16_t>());
      Connection c;
      c.topic = at.take_text();
      const std::string_view encoding = at.take_text();
      c.encoding = encoding == "cdr"    ? Encoding::cdr
                   : encoding == "ros1" ? Encoding::ros1
                                        : Encoding::unknown;
      if (schema != schemas_.end()) {
        c.type = plain_type(schema->second.name);
        if (schema->second.encoding == "ros2msg" || schema->second.encoding == "ros1msg")
          c.definition = schema->second.text;
      }
      connect(id, std::move(c));
    }
  }

  void take_metadata(std::uint64_t offset, const std::string& record) try {
    ByteCursor at{Bytes(record)};
    if (at.take_text() != kRecordedSettings) return;
    for (ByteCursor entries(at.take_counted()); entries.left() > 0;) {
      const std::string key(entries.take_text());
      settings_.emplace(key, entries.take_text());
    }
  } catch (const MalformedError& e) {
    fault(offset, std::string("a metadata record ") + e.what());
  }

  /// Goes from record to record, and behind damage from the next chunk on. False where the file is damaged or
  /// cut.
  bool find_records(std::uint64_t offset) {
    for (bool whole = true;; whole = false) {
      std::uint64_t last = offset;
      const std::string problem = walk(offset, last);
      if (problem.empty()) {
        use_summary(whole);
        return whole;
      }
      // The length of the last record may be what is wrong.
      const auto next = offset < file_bytes() ? next_chunk(last + 1) : std::nullopt;
      fault(offset, problem + (knows_chunk_at(offset) ? "" : skipped_text(offset, next)));
      if (!next) {
        use_summary(whole);
        return false;
      }
      offset = *next;
    }
  }

  /// To the footer; else why it ends at `offset`. `last`: where the record before that begins.
  std::string walk(std::uint64_t& offset, std::uint64_t& last) {
    std::optional<ChunkPlace> loose;
    const auto end_loose = [&] {
      if (loose) add_chunk(*loose);
      loose.reset();
    };
    try {
      while (offset < file_bytes()) {
        const std::string head = read_at(offset, kHead);
        ByteCursor cursor{Bytes(head)};
        const auto opcode = cursor.take<std::uint8_t>();
        const auto length = cursor.take<std::uint64_t>();
        if (opcode == 0) throw MalformedError("a record without an opcode", 0);
        const std::uint64_t left = file_bytes() - offset - kHead;
        if (opcode == kMessage && length <= left) {
          // Publishers of several topics are not in order: the least of its times is where a run begins.
          const core::TimeNs time = time_of(offset);
          if (!loose) loose = ChunkPlace{offset, offset, 0, Compression::none, 0, 0, time, ""};
          loose->start = std::min(*loose->start, time);
          loose->bytes = loose->size = offset + kHead + length - loose->offset;
          if (loose->size >= kLooseBytes) end_loose();
        } else {
          end_loose();
          if (opcode == kChunk) find_chunk(offset, length, left);
          if (length > left)
            throw MalformedError(length > kMaxChunkBytes
                                     ? "no record begins here"
                                     : "the file ends within a record: " + std::to_string(length) +
                                           " bytes are announced, " + std::to_string(left) + " are left",
                                 0);
          if (opcode == kSchema || opcode == kChannel) {
            if (length > kMaxDescription) throw MalformedError("a description of more than 16 MiB", 0);
            const std::string record = read_at(offset + kHead, length);
            take_description(opcode, Bytes(record));
            if (opcode == kChannel) ++channels_outside_;
          }
          if (opcode == kMetadata && length <= kMaxDescription)
            take_metadata(offset, read_at(offset + kHead, length));
          if (opcode == kChunk) channels_outside_ = 0;  // only those after the last chunk are a summary
          if (opcode == kFooter) {
            has_summary_ = channels_outside_ > 0;
            return "";
          }
        }
        last = offset;
        offset += kHead + length;
      }
      end_loose();
      return "the file ends without a footer: it was not closed, or is cut";
    } catch (const MalformedError& e) {
      end_loose();
      return e.what();
    }
  }

  /// The first byte from `from` on where a chunk begins whose lengths agree.
  std::optional<std::uint64_t> next_chunk(std::uint64_t from) {
    constexpr std::uint64_t kWindow = 1u << 20;
    while (from + kChunkHead < file_bytes()) {
      const std::string window = read_at(from, kWindow + kChunkHead + kMaxName);
      const std::uint64_t candidates = std::min<std::uint64_t>(window.size(), kWindow);
      for (std::size_t at = window.find(static_cast<char>(kChunk)); at < candidates;
           at = window.find(static_cast<char>(kChunk), at + 1))
        if (begins_chunk(Bytes(window).subspan(at), file_bytes() - from - at)) return from + at;
      from += kWindow;
    }
    return std::nullopt;
  }

  /// Whether these bytes, of so many that are left in the file, begin with an intact chunk's head.
  static bool begins_chunk(Bytes bytes, std::uint64_t left) try {
    ByteCursor at(bytes);
    if (at.take<std::uint8_t>() != kChunk) return false;
    const auto length = at.take<std::uint64_t>();
    const auto start = at.take<std::uint64_t>(), end = at.take<std::uint64_t>();
    const auto contents = at.take<std::uint64_t>();
    at.take<std::uint32_t>();  // check sum
    const auto name_bytes = at.take<std::uint32_t>();
    if (length > left - kHead || start > end || end > kMaxMcapTime || contents > kMaxChunkBytes ||
        name_bytes > kMaxName)
      return false;
    const Bytes name = at.take_bytes(name_bytes);
    const auto size = at.take<std::uint64_t>();
    const std::string_view compression = text_of(name);
    return length == kChunkHead - kHead + name_bytes + size &&
           (compression == "zstd" || compression == "lz4" || (compression.empty() && size == contents));
  } catch (const MalformedError&) {
    return false;
  }

  core::TimeNs time_of(std::uint64_t message) {
    const std::string head = read_at(message + kHead, 14);
    ByteCursor at{Bytes(head), 6};
    return static_cast<core::TimeNs>(std::min(at.take<std::uint64_t>(), kMaxMcapTime));
  }

  void find_chunk(std::uint64_t offset, std::uint64_t length, std::uint64_t left) {
    const std::string head = read_at(offset + kHead, std::min<std::uint64_t>(length, 64));
    ByteCursor at{Bytes(head)};
    ChunkPlace place;
    place.record = offset;
    place.start = static_cast<core::TimeNs>(std::min(at.take<std::uint64_t>(), kMaxMcapTime));
    at.take<std::uint64_t>();  // end
    place.bytes = at.take<std::uint64_t>();
    place.crc = at.take<std::uint32_t>();
    const std::string name(at.take_text());
    const auto compression = name.empty() ? Compression::none : core::parse<Compression>(name);
    place.size = at.take<std::uint64_t>();
    place.offset = offset + kHead + at.at();
    if (!compression || *compression == Compression::bz2) {
      fault(offset, "a chunk is compressed by \"" + name.substr(0, 20) + "\", which is none of lz4 and zstd");
      return;
    }
    place.compression = *compression;
    if (length > left) {
      place.cut = "it is cut";
    } else if (place.size > length - at.at()) {
      throw MalformedError("a chunk announces more records than it has", at.at());
    }
    add_chunk(place);
  }

  /// Chunks that only the summary at the end of the file tells of: a record before them has
  /// a wrong length. Behind a piece that is missing its offsets are wrong: of a file that is not whole, that
  /// is no further fault.
  void use_summary(bool whole) try {
    const std::uint64_t tail = kFooterBytes + kMcapMagic.size();
    if (file_bytes() < tail || read_at(file_bytes() - kMcapMagic.size(), 8) != kMcapMagic) return;
    const std::string footer = read_at(file_bytes() - tail, kFooterBytes);
    ByteCursor at{Bytes(footer)};
    if (at.take<std::uint8_t>() != kFooter || at.take<std::uint64_t>() != 20) return;
    const auto begin = at.take<std::uint64_t>();
    if (begin == 0 || begin > file_bytes() - tail || file_bytes() - begin > kMaxChunkBytes) return;
    const std::string summary = read_at(begin, file_bytes() - tail - begin);
    for (ByteCursor record{Bytes(summary)}; record.left() > 0;) {
      const auto opcode = record.take<std::uint8_t>();
      const Bytes body = record.take_bytes(record.take<std::uint64_t>());
      take_description(opcode, body);
      if (opcode != kChunkIndex) continue;
      ByteCursor index(body, 16);
      const auto offset = index.take<std::uint64_t>(), length = index.take<std::uint64_t>();
      if (knows_chunk_at(offset) || length < kHead || offset > file_bytes() || length > file_bytes() - offset)
        continue;
      const std::string head = read_at(offset, kHead);
      ByteCursor h{Bytes(head)};
      if (h.take<std::uint8_t>() == kChunk && h.take<std::uint64_t>() == length - kHead)
        find_chunk(offset, length - kHead, length - kHead);
    }
  } catch (const MalformedError& e) {
    if (whole) fault(file_bytes() - kFooterBytes, std::string("the summary: ") + e.what());
  }

  std::map<std::uint16_t, Schema> schemas_;
  RecordedSettings settings_;
  std::size_t channels_outside_ = 0;
  bool has_summary_ = false;
};

}  // namespace

std::unique_ptr<Bag> open_mcap(const std::string& path) { return std::make_unique<McapBag>(path); }

}  // namespace karst::replay
