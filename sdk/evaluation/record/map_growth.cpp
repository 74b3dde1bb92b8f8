#include "sdk/evaluation/record/map_growth.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::evaluation {
namespace {

constexpr std::size_t kRecordBytes = 16;
constexpr std::int32_t kFarthestCell = 1 << 24;  // thousands of kilometres: a damaged file

bool plausible(const core::CellKey& k) {
  const auto near = [](std::int32_t v) { return v > -kFarthestCell && v < kFarthestCell; };
  return near(k.x) && near(k.y) && near(k.z);
}

std::int32_t little_endian(const char* bytes) {
  std::array<unsigned char, 4> b;
  std::memcpy(b.data(), bytes, 4);
  const std::uint32_t v = b[0] | (b[1] << 8) | (b[2] << 16) | (static_cast<std::uint32_t>(b[3]) << 24);
  return static_cast<std::int32_t>(v);
}

}  // namespace

std::vector<OccupiedSpan> read_map_growth(const std::filesystem::path& file,
                                          std::vector<std::string>& problems) {
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return {};
  std::string bytes;
  try {
    bytes = core::read_input(file, core::kMaxRecordFileBytes);
  } catch (const core::InputError& e) {
    problems.push_back(e.what());
    return {};
  }
  if (bytes.size() % kRecordBytes != 0)
    problems.push_back(file.filename().string() + ": byte " +
                       std::to_string(bytes.size() / kRecordBytes * kRecordBytes) +
                       ": a record is cut off; only those before it are used");

  struct Change {
    core::CellKey key;
    std::int32_t t_ms;
  };
  std::vector<Change> changes;
  std::size_t implausible = 0, empty = 0;
  for (std::size_t i = 0; i + kRecordBytes <= bytes.size(); i += kRecordBytes) {
    const char* p = bytes.data() + i;
    const core::CellKey key{little_endian(p), little_endian(p + 4), little_endian(p + 8)};
    const std::int32_t t_ms = little_endian(p + 12);
    // No cell changes at 0 ms: a power cut left zeros where data did not reach the disk.
    if (key == core::CellKey{} && t_ms == 0)
      ++empty;
    else if (plausible(key))
      changes.push_back({key, t_ms});
    else
      ++implausible;
  }
  if (empty > 0)
    problems.push_back(file.filename().string() + ": " + std::to_string(empty) +
                       " records were never written, and are zeros; left out");
  if (implausible > 0)
    problems.push_back(file.filename().string() + ": " + std::to_string(implausible) +
                       " records name cells out of this world; left out");
  // The file is in the order of time: a stable sort by key keeps each cell's changes in that order.
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.key < b.key; });
  std::vector<OccupiedSpan> spans;
  for (const Change& c : changes) {
    const bool open =
        !spans.empty() && spans.back().key == c.key && spans.back().until_ms == OccupiedSpan::kNever;
    if (c.t_ms >= 0 && !open) spans.push_back({c.key, c.t_ms, OccupiedSpan::kNever});
    if (c.t_ms < 0 && open) spans.back().until_ms = -std::max(c.t_ms, -INT32_MAX);
  }
  return spans;
}

}  // namespace karst::evaluation
