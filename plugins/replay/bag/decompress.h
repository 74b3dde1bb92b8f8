// Decompresses a bag's chunk as far as it is intact.
#pragma once
#include <string>

#include "core_stack/common/enum_names.h"
#include "plugins/replay/bag/bytes.h"

namespace karst::replay {

enum class Compression { none, bz2, lz4, zstd };
constexpr auto names_of(Compression) {
  using enum Compression;
  return std::to_array<core::Named<Compression>>(
      {{none, "none"}, {bz2, "bz2"}, {lz4, "lz4"}, {zstd, "zstd"}});
}

/// A chunk that is larger than this is refused: writers make chunks of about a megabyte.
constexpr std::size_t kMaxChunkBytes = 256u << 20;

struct Decompressed {
  std::string bytes;    // what could be decompressed
  std::string problem;  // "" if that is all of it
};

/// lz4 and zstd are frames, bz2 is a stream; nothing may follow its end. `declared` is the number of bytes
/// expected; it only serves to check, and memory grows with the real number.
Decompressed decompress(Compression compression, Bytes compressed, std::uint64_t declared);

}  // namespace karst::replay
