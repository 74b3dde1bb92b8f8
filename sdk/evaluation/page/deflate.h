// Deflate in zlib's format (RFC 1950), which browsers can decompress natively.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace karst::evaluation {

std::vector<std::byte> deflated(std::span<const std::byte> bytes);

}  // namespace karst::evaluation
