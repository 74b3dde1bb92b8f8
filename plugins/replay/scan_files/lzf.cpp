#include "plugins/replay/scan_files/lzf.h"

namespace karst::replay {

std::optional<std::string> lzf_decompress(std::span<const char> in, std::size_t size) {
  std::string out;
  out.reserve(size);
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(in[i]));
  };
  for (std::size_t at = 0; at < in.size();) {
    const std::size_t c = byte(at++);
    if (c < 32) {
      const std::size_t count = c + 1;
      if (count > in.size() - at || count > size - out.size()) return std::nullopt;
      out.append(in.data() + at, count);
      at += count;
      continue;
    }
    std::size_t count = 2 + (c >> 5);
    if (count == 9) {
      if (at >= in.size()) return std::nullopt;
      count += byte(at++);
    }
    if (at >= in.size()) return std::nullopt;
    const std::size_t back = 1 + 256 * (c & 31) + byte(at++);
    if (back > out.size() || count > size - out.size()) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) out.push_back(out[out.size() - back]);  // may overlap itself
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace karst::replay
