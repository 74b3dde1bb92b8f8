// The wire format's integers: little-endian, with every length checked.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace karst::core {

using Bytes = std::vector<std::uint8_t>;

class WireWriter {
 public:
  explicit WireWriter(Bytes& out) : out_(out) {}

  /// The lowest `bytes` bytes.
  void number(std::uint64_t v, int bytes) {
    for (int i = 0; i < bytes; ++i) out_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  void byte(std::uint8_t v) { out_.push_back(v); }
  /// Seven bits a byte, lowest first: small numbers are short (LEB128).
  void compact(std::uint32_t v) {
    for (; v >= 0x80; v >>= 7) out_.push_back(static_cast<std::uint8_t>(v | 0x80));
    out_.push_back(static_cast<std::uint8_t>(v));
  }

 private:
  Bytes& out_;
};

/// Reads past the end return zero and set `bad()` permanently, so a single check at the end suffices.
class WireReader {
 public:
  explicit WireReader(std::span<const std::uint8_t> in) : in_(in) {}

  std::uint64_t number(int bytes) {
    if (in_.size() < static_cast<std::size_t>(bytes)) return fail();
    std::uint64_t v = 0;
    for (int i = 0; i < bytes; ++i) v |= std::uint64_t{in_[static_cast<std::size_t>(i)]} << (8 * i);
    in_ = in_.subspan(static_cast<std::size_t>(bytes));
    return v;
  }
  /// Two's complement in `bytes` bytes.
  std::int64_t whole(int bytes) {
    const int unused = 64 - 8 * bytes;
    return static_cast<std::int64_t>(number(bytes) << unused) >> unused;
  }
  std::uint8_t byte() { return static_cast<std::uint8_t>(number(1)); }
  std::uint32_t compact() {
    std::uint64_t v = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t b = byte();
      v |= std::uint64_t{b & 0x7fu} << shift;
      // Each number has one encoding: no leading zeros, no more than 32 bits.
      if (b < 0x80)
        return (b == 0 && shift > 0) || v > 0xffffffffu ? static_cast<std::uint32_t>(fail())
                                                        : static_cast<std::uint32_t>(v);
    }
    return static_cast<std::uint32_t>(fail());
  }
  std::span<const std::uint8_t> bytes(std::size_t n) {
    if (in_.size() < n) {
      fail();
      return {};
    }
    const auto out = in_.first(n);
    in_ = in_.subspan(n);
    return out;
  }
  std::size_t left() const { return in_.size(); }
  bool bad() const { return bad_; }

 private:
  std::uint64_t fail() {
    bad_ = true;
    in_ = {};
    return 0;
  }

  std::span<const std::uint8_t> in_;
  bool bad_ = false;
};

}  // namespace karst::core
