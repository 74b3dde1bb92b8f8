// What came from a sensor and what did not, since it was opened.
#pragma once
#include <cstdint>

namespace karst::lidar {

struct PacketCounts {
  std::uint64_t packets = 0;     // taken in
  std::uint64_t foreign = 0;     // ignored: of another sensor, or of another kind
  std::uint64_t malformed = 0;   // ignored: damaged, or with values that cannot be
  std::uint64_t late = 0;        // ignored: of a sweep that was closed, or that had come before
  std::uint64_t lost = 0;        // never came: packets of Livox, columns of Ouster
  std::uint64_t scans = 0;       // delivered
  std::uint64_t lost_scans = 0;  // of which nothing came

  bool operator==(const PacketCounts&) const = default;
};

}  // namespace karst::lidar
