// Values as the bytes of binary files.
#pragma once
#include <bit>
#include <string>
#include <type_traits>

namespace karst::core {

static_assert(std::endian::native == std::endian::little, "binary files are written as the machine has it");

template <class T>
requires std::is_arithmetic_v<T>
void append_bytes(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace karst::core
