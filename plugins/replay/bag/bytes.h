// Reading of little-endian binary records whose lengths may lie.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace karst::replay {

using Bytes = std::span<const char>;

/// A record or message is not what its format says; `at` is the byte in it where that shows.
class MalformedError : public std::runtime_error {
 public:
  MalformedError(const std::string& reason, std::size_t at) : std::runtime_error(reason), at_(at) {}
  std::size_t at() const { return at_; }

 private:
  std::size_t at_;
};

/// Takes values one after another. Throws MalformedError where the bytes end too soon.
class ByteCursor {
 public:
  explicit ByteCursor(Bytes bytes, std::size_t at = 0) : bytes_(bytes), at_(0) { take_bytes(at); }

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  template <class T>
  T take() {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, take_bytes(sizeof value).data(), sizeof value);
    return value;
  }
  Bytes take_bytes(std::uint64_t count) {
    if (count > left())
      throw MalformedError("ends within a value: " + std::to_string(count) + " bytes are announced, " +
                               std::to_string(left()) + " are left",
                           at_);
    const Bytes part = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += part.size();
    return part;
  }
  /// Bytes after their number, as 32 bits.
  Bytes take_counted() { return take_bytes(take<std::uint32_t>()); }
  std::string_view take_text() {
    const Bytes text = take_counted();
    return {text.data(), text.size()};
  }

 private:
  Bytes bytes_;
  std::size_t at_;
};

}  // namespace karst::replay
