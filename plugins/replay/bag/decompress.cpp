#include "plugins/replay/bag/decompress.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace karst::replay {
namespace {

/// Output that grows by a step at a time.
class GrowingOutput {
 public:
  explicit GrowingOutput(std::uint64_t declared)
      : step_(std::clamp<std::uint64_t>(declared, 1u << 12, 1u << 22)) {}
  /// Room for at least one more byte; false when the chunk is too large.
  bool make_room() {
    if (used_ < bytes_.size()) return true;
    if (used_ >= kMaxChunkBytes) return false;
    bytes_.resize(std::min(kMaxChunkBytes, used_ + std::max(step_, used_)));
    return true;
  }
  char* room() { return bytes_.data() + used_; }
  std::size_t room_bytes() const { return bytes_.size() - used_; }
  void use(std::size_t count) { used_ += count; }
  std::string take() {
    bytes_.resize(used_);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
  std::size_t used_ = 0, step_;
};

const std::string kTooLarge = "is larger than " + std::to_string(kMaxChunkBytes >> 20) + " MiB";
constexpr const char* kCut = "its compressed data are cut";

/// "" if the compressed data end where the chunk does.
std::string beyond_end(std::size_t left) {
  return left == 0 ? "" : std::to_string(left) + " bytes follow its compressed data";
}

std::string bunzip(Bytes in, GrowingOutput& out) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return "bz2 cannot be set up";
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(in.data());
  stream.avail_in = static_cast<unsigned>(in.size());
  for (;;) {
    if (!out.make_room()) return kTooLarge;
    const unsigned room = static_cast<unsigned>(out.room_bytes());
    stream.next_out = out.room();
    stream.avail_out = room;
    const unsigned input = stream.avail_in;
    const int result = BZ2_bzDecompress(&stream);
    out.use(room - stream.avail_out);
    if (result == BZ_STREAM_END) return beyond_end(stream.avail_in);
    if (result != BZ_OK) return "is no intact bz2 data";
    if (stream.avail_out == room && stream.avail_in == input) return kCut;
  }
}

std::string unlz4(Bytes in, GrowingOutput& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) return "lz4 cannot be set up";
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(raw,
                                                                             LZ4F_freeDecompressionContext);
  for (std::size_t at = 0;;) {
    if (!out.make_room()) return kTooLarge;
    std::size_t given = out.room_bytes(), taken = in.size() - at;
    const std::size_t result = LZ4F_decompress(raw, out.room(), &given, in.data() + at, &taken, nullptr);
    if (LZ4F_isError(result)) return std::string("is no intact lz4 frame: ") + LZ4F_getErrorName(result);
    out.use(given);
    at += taken;
    if (result == 0) return beyond_end(in.size() - at);
    if (given == 0 && taken == 0) return kCut;
  }
}

std::string unzstd(Bytes in, GrowingOutput& out) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) return "zstd cannot be set up";
  ZSTD_inBuffer input{in.data(), in.size(), 0};
  for (;;) {
    if (!out.make_room()) return kTooLarge;
    ZSTD_outBuffer output{out.room(), out.room_bytes(), 0};
    const std::size_t before = input.pos, result = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(result)) return std::string("is no intact zstd frame: ") + ZSTD_getErrorName(result);
    out.use(output.pos);
    if (result == 0) return beyond_end(input.size - input.pos);
    if (output.pos == 0 && input.pos == before) return kCut;
  }
}

}  // namespace

Decompressed decompress(Compression compression, Bytes compressed, std::uint64_t declared) {
  GrowingOutput out(declared);
  std::string problem;
  switch (compression) {
    case Compression::none:
      return {std::string(compressed.begin(), compressed.end()), ""};
    case Compression::bz2:
      problem = bunzip(compressed, out);
      break;
    case Compression::lz4:
      problem = unlz4(compressed, out);
      break;
    case Compression::zstd:
      problem = unzstd(compressed, out);
      break;
  }
  Decompressed result{out.take(), std::move(problem)};
  if (result.problem.empty() && result.bytes.size() != declared)
    result.problem = "decompresses to " + std::to_string(result.bytes.size()) + " bytes instead of the " +
                     std::to_string(declared) + " it announces";
  return result;
}

}  // namespace karst::replay
