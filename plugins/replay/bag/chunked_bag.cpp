#include "plugins/replay/bag/chunked_bag.h"

#include <zlib.h>

#include <algorithm>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::replay {
namespace {

/// Chunks of recorders have about a megabyte: up to this size their length is believed.
constexpr std::uint64_t kBelievedBytes = 16u << 20;

/// Bytes of the file that are read of a chunk at most. Compression makes nothing larger by more than a
/// hundredth.
std::uint64_t most_stored(const ChunkPlace& place) {
  const std::uint64_t contents = std::min<std::uint64_t>(place.bytes, kMaxChunkBytes);
  return std::clamp<std::uint64_t>(contents + contents / 64, kBelievedBytes, kMaxChunkBytes);
}

std::uint32_t crc_of(Bytes bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

// Few chunks overlap.
constexpr std::size_t kMaxOpenChunkBytes = 64u << 20;

}  // namespace

ChunkedBag::ChunkedBag(const std::string& path)
    : path_(path), file_(core::open_input(path, core::kMaxDataFileBytes)) {
  file_.seekg(0, std::ios::end);
  file_bytes_ = static_cast<std::uint64_t>(file_.tellg());
}

std::string ChunkedBag::read_at(std::uint64_t offset, std::uint64_t size) {
  if (offset >= file_bytes_) return "";
  std::string bytes(static_cast<std::size_t>(std::min(size, file_bytes_ - offset)), '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file_.gcount()));
  return bytes;
}

std::string ChunkedBag::skipped_text(std::uint64_t byte, std::optional<std::uint64_t> next) const {
  if (next) return "; reading goes on with the chunk at byte " + std::to_string(*next);
  if (byte >= file_bytes_) return "";
  return "; the " + std::to_string(file_bytes_ - byte) + " bytes from there on are not read";
}

void ChunkedBag::connect(std::uint32_t number, Connection connection) {
  if (by_number_.emplace(number, connections_.size()).second) connections_.push_back(std::move(connection));
}

std::optional<std::size_t> ChunkedBag::connection_of(std::uint32_t number) const {
  const auto found = by_number_.find(number);
  return found == by_number_.end() ? std::nullopt : std::optional(found->second);
}

void ChunkedBag::add_chunk(ChunkPlace place) {
  records_.insert(place.record);
  chunks_.push_back(place);
}

LoadedChunk ChunkedBag::load(std::size_t chunk, bool log) {
  const ChunkPlace& place = chunks_[chunk];
  const auto report = [&](const std::string& reason) {
    if (log)
      faults_.add("byte " + std::to_string(place.offset) + ", chunk " + std::to_string(chunk + 1) + " of " +
                      std::to_string(chunks_.size()),
                  reason);
  };
  LoadedChunk loaded;
  const std::uint64_t most = most_stored(place);
  std::string stored = read_at(place.offset, std::min(place.size, most));
  std::string problem(place.cut);
  if (problem.empty() && place.size > most)
    problem = "announces " + std::to_string(place.size) + " bytes, more than it can have";
  Decompressed d = place.compression == Compression::none
                       ? Decompressed{std::move(stored), ""}
                       : decompress(place.compression, stored, place.bytes);
  if (problem.empty()) problem = d.problem;
  const bool whole = place.cut.empty() && (d.problem.empty() || d.bytes.size() == place.bytes);
  if (whole && place.crc != 0 && crc_of(d.bytes) != place.crc) {
    // Of two lengths that differ, the check sum tells the right one.
    const bool longer = d.bytes.size() > place.bytes;
    if (longer && crc_of(Bytes(d.bytes).first(place.bytes)) == place.crc) {
      d.bytes.resize(place.bytes);
      if (problem.empty()) problem = "more bytes follow than it announces";
    } else {
      report("its check sum is wrong: none of its messages is used");
      take_descriptions(d.bytes);
      return loaded;
    }
  }
  loaded.bytes = std::move(d.bytes);
  try {
    parse(loaded.bytes, loaded.messages);
  } catch (const MalformedError& e) {
    if (problem.empty()) problem = "byte " + std::to_string(e.at()) + " in it: " + e.what();
  }
  if (!problem.empty())
    report(problem + "; " + std::to_string(loaded.messages.size()) + " messages before that are used");
  return loaded;
}

void ChunkedBag::take_descriptions(Bytes records) {
  // Later chunks may need what only this one describes. What is described elsewhere stays as it is.
  std::vector<ChunkMessage> unused;
  try {
    parse(records, unused);
  } catch (const MalformedError&) {
  }
}

void ChunkedBag::rebuild_index(bool all) {
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    if (!all && chunks_[i].start) continue;
    const LoadedChunk loaded = load(i, false);
    if (!loaded.messages.empty())
      chunks_[i].start =
          std::min_element(loaded.messages.begin(), loaded.messages.end(), [](const auto& a, const auto& b) {
            return a.time < b.time;
          })->time;
  }
}

void ChunkedBag::finish_opening() {
  if (!connections_.empty()) return;
  if (faults_.count() == 0) throw core::InputError(path_, "", "holds no topic");
  throw core::InputError(path_, faults_.first().front().place,
                         faults_.first().front().reason + "; nothing before that can be used");
}

core::TimeNs ChunkedBag::begin() const {
  core::TimeNs earliest = std::numeric_limits<core::TimeNs>::max();
  for (const ChunkPlace& c : chunks_) earliest = std::min(earliest, c.start.value_or(unknown_begin()));
  return earliest;
}

std::optional<BagMessage> ChunkedBag::next() {
  if (!merge_) {
    std::vector<core::TimeNs> start;
    for (const ChunkPlace& c : chunks_) start.push_back(c.start.value_or(0));
    merge_.emplace(
        std::move(start),
        [this](std::size_t i) {
          LoadedChunk loaded = load(i, true);
          if (!wanted_.empty())
            std::erase_if(loaded.messages, [&](const ChunkMessage& m) {
              return m.connection >= wanted_.size() || !wanted_[m.connection];
            });
          return loaded;
        },
        kMaxOpenChunkBytes);
  }
  const auto item = merge_->next();
  if (!item) return std::nullopt;
  return BagMessage{item->message.connection, item->message.time, item->bytes,
                    static_cast<std::size_t>(chunks_[item->chunk].offset), item->message.offset};
}

}  // namespace karst::replay
