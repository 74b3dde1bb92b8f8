// LZF, the compression of "binary_compressed" PCD files.
#pragma once
#include <optional>
#include <span>
#include <string>

namespace karst::replay {

/// Exactly `size` bytes; nullopt if the input is damaged, or decompresses to another size.
///
/// The stream is a sequence of runs that begin with a byte c. If c < 32, c + 1 literal bytes follow. Else
/// earlier output is repeated: 2 + (c >> 5) bytes, or 9 plus the next byte if c >> 5 is 7; they begin
/// 1 + 256 (c & 31) + (the byte after that) bytes back.
std::optional<std::string> lzf_decompress(std::span<const char> in, std::size_t size);

}  // namespace karst::replay
