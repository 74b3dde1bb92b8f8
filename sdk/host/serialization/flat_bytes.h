// Values to bytes and back, for messages to another process and for files.
//
// Numbers are written in this machine's format: both ends are the same build, or a file states its version.
// Data read is not trusted: every length is checked against the bytes left, every number against its
// range.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::host {

using Bytes = std::vector<std::byte>;

/// The bytes are not valid. `what()` gives the byte position and the reason.
struct FlatError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class T>
concept FlatNumber = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

class FlatWriter {
 public:
  template <FlatNumber T>
  void put(T v) {
    put_raw(&v, sizeof v);
  }
  void put(bool v) { put<std::uint8_t>(v ? 1 : 0); }
  void put(const core::Vec3& v) {
    put(v.x());
    put(v.y());
    put(v.z());
  }
  void put(const core::Quat& q) {
    put(q.w());
    put(q.x());
    put(q.y());
    put(q.z());
  }
  void put(const core::Pose& p) {
    put(p.position);
    put(p.orientation);
  }
  void put(const std::string& s) {
    put<std::uint64_t>(s.size());
    put_raw(s.data(), s.size());
  }
  void put_raw(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }
  const Bytes& bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

class FlatReader {
 public:
  explicit FlatReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <FlatNumber T>
  T number() {
    T v;
    std::memcpy(&v, raw(sizeof v).data(), sizeof v);
    return v;
  }
  bool flag() {
    const auto v = number<std::uint8_t>();
    if (v > 1) fail("a flag is neither 0 nor 1");
    return v == 1;
  }
  core::Vec3 vec3() {
    const double x = number<double>(), y = number<double>(), z = number<double>();
    return {x, y, z};
  }
  core::Quat quat() {
    const double w = number<double>(), x = number<double>(), y = number<double>(), z = number<double>();
    return {w, x, y, z};
  }
  core::Pose pose() {
    const core::Vec3 p = vec3();
    return {p, quat()};
  }
  /// A number from `low` to `high`.
  std::uint32_t choice(std::uint32_t low, std::uint32_t high, const char* name) {
    const auto v = number<std::uint32_t>();
    if (v < low || v > high) fail(std::string(name) + " is out of range");
    return v;
  }
  /// Number of items that follow, each of which takes `min_bytes` or more.
  std::size_t count(std::size_t min_bytes, std::uint64_t most, const char* name) {
    const auto n = number<std::uint64_t>();
    if (n > most || n * min_bytes > left()) fail(std::string("there cannot be so many ") + name);
    return static_cast<std::size_t>(n);
  }
  std::string text(std::uint64_t most) {
    const std::span<const std::byte> s = raw(count(1, most, "bytes in a text"));
    return {reinterpret_cast<const char*>(s.data()), s.size()};
  }
  std::span<const std::byte> raw(std::size_t size) {
    if (size > left()) fail("it ends too early");
    const std::span<const std::byte> out = bytes_.subspan(at_, size);
    at_ += size;
    return out;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  void require_end() const {
    if (left() > 0) fail("more follows than belongs to it");
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw FlatError("byte " + std::to_string(at_) + ": " + why);
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace karst::host
