#include "sdk/evaluation/page/deflate.h"

#include <zlib.h>

#include <stdexcept>

namespace karst::evaluation {

std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::byte> out(size);
  const int result =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), Z_BEST_COMPRESSION);
  if (result != Z_OK) throw std::runtime_error("zlib cannot compress: out of memory");
  out.resize(size);
  return out;
}

}  // namespace karst::evaluation
