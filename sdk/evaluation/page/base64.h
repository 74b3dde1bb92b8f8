// Base64 (RFC 4648), to carry binary arrays inside the report's JSON.
#pragma once
#include <bit>
#include <span>
#include <string>
#include <vector>

namespace karst::evaluation {

std::string base64(std::span<const std::byte> bytes);

/// The array's bytes, little endian, as the report's typed arrays expect them.
template <class T>
std::string base64_of(const std::vector<T>& values) {
  static_assert(std::endian::native == std::endian::little);
  return base64(std::as_bytes(std::span(values)));
}

}  // namespace karst::evaluation
