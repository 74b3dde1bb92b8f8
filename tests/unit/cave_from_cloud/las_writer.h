// Writes LAS files from the specification's tables (ASPRS, LAS 1.0 to 1.4), apart from the reader.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/unit/replay/folder.h"

namespace karst::test {

inline bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct LasPoint {
  std::array<std::int32_t, 3> stored{};
  bool withheld = false;
};

struct LasFile {
  unsigned minor = 2, format = 0;
  std::size_t extra_bytes = 0;  // at the end of each record
  std::array<double, 3> scale{0.001, 0.001, 0.001}, offset{0, 0, 0};
  std::vector<LasPoint> points;

  std::size_t record_bytes() const {
    constexpr std::array<std::size_t, 11> kBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    return kBytes[format] + extra_bytes;
  }
  std::size_t header_bytes() const { return minor == 4 ? 375 : minor == 3 ? 235 : 227; }
  /// A variable length record, or what else stands between header and points.
  static constexpr std::size_t kBetween = 54;

  std::string bytes() const {
    std::string b = "LASF";
    put(b, std::uint32_t{0});  // source, encoding
    b += std::string(16, '\0');
    put(b, std::uint8_t{1});
    put(b, static_cast<std::uint8_t>(minor));
    b += std::string(64, ' ');  // system, software
    put(b, std::uint32_t{0});   // day, year
    put(b, static_cast<std::uint16_t>(header_bytes()));
    put(b, static_cast<std::uint32_t>(header_bytes() + kBetween));
    put(b, std::uint32_t{1});  // number of variable length records
    put(b, static_cast<std::uint8_t>(format));
    put(b, static_cast<std::uint16_t>(record_bytes()));
    const bool legacy = minor < 4 || format < 6;
    put(b, static_cast<std::uint32_t>(legacy ? points.size() : 0));
    b += std::string(20, '\0');  // points by return
    for (const double v : scale) put(b, v);
    for (const double v : offset) put(b, v);
    b += std::string(48, '\0');                 // greatest and least coordinates
    if (minor >= 3) b += std::string(8, '\0');  // waveforms
    if (minor == 4) {
      b += std::string(12, '\0');  // extended records
      put(b, static_cast<std::uint64_t>(points.size()));
      b += std::string(120, '\0');
    }
    b += std::string(kBetween, '\x5a');
    for (const LasPoint& p : points) {
      std::string record;
      for (const std::int32_t v : p.stored) put(record, v);
      record.resize(record_bytes(), '\x11');
      // Formats 0 to 5: the highest bit of the classification. 6 to 10: bit 2 of the flags. Both in byte 15.
      record[15] = static_cast<char>(p.withheld ? (format < 6 ? 0x82 : 0x04) : (format < 6 ? 0x02 : 0x00));
      b += record;
    }
    return b;
  }
};

}  // namespace karst::test
