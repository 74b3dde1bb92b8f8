// Values as the bytes of binary files.
#pragma once
#include <bit>
#include <string>

namespace karst::survey_export {

static_assert(std::endian::native == std::endian::little, "binary files are written as the machine has it");

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace karst::survey_export
