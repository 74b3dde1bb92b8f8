#include "sdk/evaluation/reachable/reachable_file.h"

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "sdk/evaluation/reachable/cache_file.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;

// File format: key, bounds of the cells, then the blocks that are not empty: block coordinates and a block of
// each set; at the end a checksum of the whole file.
constexpr std::uint64_t kVersion = 1;  // of the file format and of find_reachable's result
using Bytes = std::string;

struct BlockEntry {
  std::uint64_t place;
  CellSet::Block free, flyable, reachable;
};
struct Head {
  std::uint64_t key;
  std::array<std::int32_t, 6> bounds;  // lowest and highest cell
};

std::uint64_t key_of(const cave::TriangleMesh& mesh, const core::Vec3& start, const ReachableOptions& o) {
  const std::array<double, 6> numbers{start.x(),      start.y(),     start.z(),
                                      o.resolution_m, o.clearance_m, o.sight_m};
  std::uint64_t hash = word_sum(std::as_bytes(std::span(numbers)), kVersion);
  hash = word_sum(std::as_bytes(std::span(mesh.vertices)), hash);
  return word_sum(std::as_bytes(std::span(mesh.triangles)), hash);
}

template <class T>
void append(Bytes& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::uint64_t sum_of(const Bytes& bytes, std::size_t size) {
  return word_sum(std::as_bytes(std::span(bytes.data(), size)));
}

Bytes bytes_of(const Reachable& r, std::uint64_t key) {
  const CellKey n = r.free.blocks_along();
  const CellKey low = r.free.first_cell({}), high = r.free.first_cell({n.x - 1, n.y - 1, n.z - 1});
  Bytes out;
  append(out, Head{key, {low.x, low.y, low.z, high.x, high.y, high.z}});
  r.free.for_each_block([&](const CellKey& p, const CellSet::Block& free) {
    const auto block = [&](const CellSet& set) {
      const auto* b = set.find(p);
      return b ? *b : CellSet::Block{};
    };
    append(out, BlockEntry{r.free.index_of(p), free, block(r.flyable), block(r.reachable)});
  });
  append(out, sum_of(out, out.size()));
  return out;
}

std::optional<Reachable> read(const fs::path& file, std::uint64_t key, const ReachableOptions& options) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  Bytes bytes;
  try {
    bytes = core::read_input(file, core::kMaxRecordFileBytes);
  } catch (const core::InputError&) {  // it is a cache: an unreadable file is computed again
    return std::nullopt;
  }
  constexpr std::size_t around = sizeof(Head) + sizeof(std::uint64_t);
  if (bytes.size() < around || (bytes.size() - around) % sizeof(BlockEntry) != 0) return std::nullopt;
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  Head head{};
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.key != key || sum != sum_of(bytes, bytes.size() - sizeof sum)) return std::nullopt;
  const auto& b = head.bounds;
  Reachable r;
  r.options = options;
  r.free = r.flyable = r.reachable = CellSet({b[0], b[1], b[2]}, {b[3], b[4], b[5]});
  const CellKey n = r.free.blocks_along();
  for (std::size_t at = sizeof(Head); at + sizeof(BlockEntry) < bytes.size(); at += sizeof(BlockEntry)) {
    BlockEntry e;
    std::memcpy(&e, bytes.data() + at, sizeof e);
    const auto nx = static_cast<std::uint64_t>(n.x), ny = static_cast<std::uint64_t>(n.y);
    const CellKey p{static_cast<std::int32_t>(e.place % nx), static_cast<std::int32_t>(e.place / nx % ny),
                    static_cast<std::int32_t>(e.place / (nx * ny))};
    if (!r.free.has_place(p)) return std::nullopt;
    r.free.at(p) = e.free;
    r.flyable.at(p) = e.flyable;
    r.reachable.at(p) = e.reachable;
  }
  r.free_cells = r.free.size();
  r.flyable_cells = r.flyable.size();
  r.reachable_cells = r.reachable.size();
  return r;
}

}  // namespace

Reachable find_reachable_once(const cave::TriangleMesh& mesh, const core::Vec3& start,
                              const ReachableOptions& options, const std::string& name,
                              const fs::path& folder) {
  if (folder.empty()) return find_reachable(mesh, start, options, name);
  const std::uint64_t key = key_of(mesh, start, options);
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%016llx.reachable", static_cast<unsigned long long>(key));
  const fs::path file = folder / text.data();
  if (auto known = read(file, key, options)) return std::move(*known);
  Reachable found = find_reachable(mesh, start, options, name);
  write_cache_file(file, bytes_of(found, key));
  return found;
}

}  // namespace karst::evaluation
