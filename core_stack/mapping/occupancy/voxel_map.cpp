#include "core_stack/mapping/occupancy/voxel_map.h"

#include "core_stack/mapping/occupancy/cell_walk.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/mapping/occupancy/voxel_storage.h"
#include "core_stack/mapping/region/flight_region.h"

namespace karst::core {
namespace {

std::int16_t scaled_logit(double p) {
  return static_cast<std::int16_t>(std::lround(std::log(p / (1.0 - p)) * kLogOddsScale));
}

/// Cell index of a coordinate, clamped well inside int32 and outside the world; NaN counts as far outside.
std::int32_t cell_of(double cells) {
  constexpr double limit = 1e9;
  if (!(cells > -limit)) return static_cast<std::int32_t>(-limit);
  return static_cast<std::int32_t>(std::floor(std::min(cells, limit)));
}

/// traverse() in packed cells.
template <class Visit>
void walk(const Vec3& from, const Vec3& to, double resolution_m, const Visit& visit) {
  constexpr double limit = kPackedLimit;
  const Vec3 a = from / resolution_m, b = to / resolution_m;
  if ((a.array().abs() < limit).all() && (b.array().abs() < limit).all()) walk_cells(a, b, visit);  // not NaN
}

}  // namespace

void describe(OptionTable& t, MapOptions& o) {
  t.add("resolution", o.resolution_m, "m", 0.02, 2.0, "edge length of a map cell");
  t.add("hit_probability", o.hit_probability, "", 0.51, 0.99, "a hit cell is occupied with this probability");
  t.add("miss_probability", o.miss_probability, "", 0.01, 0.49,
        "a passed cell is occupied with this probability");
  t.add("min_probability", o.min_probability, "", 0.001, 0.49, "no cell becomes surer to be free than this");
  t.add("max_probability", o.max_probability, "", 0.51, 0.999,
        "no cell becomes surer to be occupied than this");
}

std::size_t CellKeyHash::operator()(const CellKey& k) const {
  std::uint64_t h = static_cast<std::uint32_t>(k.x) * 0x9e3779b97f4a7c15ull;
  h = (h ^ (h >> 32) ^ static_cast<std::uint32_t>(k.y)) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 32) ^ static_cast<std::uint32_t>(k.z)) * 0x94d049bb133111ebull;
  return h ^ (h >> 31);
}

VoxelMap::Storage::Storage(const MapOptions& o)
    : resolution_m(o.resolution_m),
      cells_per_m(1.0 / o.resolution_m),
      hit(scaled_logit(o.hit_probability)),
      miss(scaled_logit(o.miss_probability)),
      low(scaled_logit(o.min_probability)),
      high(scaled_logit(o.max_probability)) {}

VoxelMap::VoxelMap(const MapOptions& options) : storage_(std::make_unique<Storage>(options)) {}
VoxelMap::~VoxelMap() = default;
VoxelMap::VoxelMap(VoxelMap&&) noexcept = default;
VoxelMap& VoxelMap::operator=(VoxelMap&&) noexcept = default;

double VoxelMap::resolution_m() const { return storage_->resolution_m; }

CellKey VoxelMap::key_of(const Vec3& p) const {
  const double s = storage_->cells_per_m;
  return {cell_of(p.x() * s), cell_of(p.y() * s), cell_of(p.z() * s)};
}

Vec3 VoxelMap::center_of(const CellKey& k) const {
  return (Vec3(k.x, k.y, k.z) + Vec3::Constant(0.5)) * storage_->resolution_m;
}

Cell VoxelMap::at(const CellKey& k) const {
  if (!in_world(k)) return Cell::unknown;
  const Block* b = storage_->blocks.find(block_of(k));
  return b == nullptr ? Cell::unknown : class_of(b->log_odds[local_of(k)]);
}

std::optional<float> VoxelMap::log_odds(const CellKey& k) const {
  if (at(k) == Cell::unknown) return std::nullopt;
  return static_cast<float>(storage_->blocks.find(block_of(k))->log_odds[local_of(k)]) / kLogOddsScale;
}

void VoxelMap::confine(std::shared_ptr<const FlightRegion> region) { storage_->region = std::move(region); }

const FlightRegion* VoxelMap::region() const { return storage_->region.get(); }

bool VoxelMap::may_fly(const CellKey& k) const {
  return at(k) == Cell::free && (!storage_->region || storage_->region->may_fly(center_of(k)));
}

std::size_t VoxelMap::free_cells() const { return storage_->free_cells; }
std::size_t VoxelMap::occupied_cells() const { return storage_->occupied_cells; }
double VoxelMap::free_volume_m3() const {
  const double r = storage_->resolution_m;
  return static_cast<double>(storage_->free_cells) * r * r * r;
}

std::uint64_t VoxelMap::revision() const { return storage_->revision; }

std::uint64_t VoxelMap::revision_near(const Vec3& center, double radius_m) const {
  const Vec3 radius = Vec3::Constant(radius_m);
  std::uint64_t latest = 0;
  for (const Block* b : blocks_in_box(storage_->blocks, key_of(center - radius), key_of(center + radius))) {
    const CellKey c = corner_of(b->id);
    const Vec3 low = Vec3(c.x, c.y, c.z) * storage_->resolution_m;
    const Vec3 high = low + Vec3::Constant(kBlockEdge * storage_->resolution_m);
    const Vec3 nearest = center.cwiseMax(low).cwiseMin(high);
    if ((nearest - center).norm() <= radius_m) latest = std::max(latest, b->revision);
  }
  return latest;
}

std::optional<CellKey> VoxelMap::first_not_free(const Vec3& from, const Vec3& to) const {
  VoxelReader reader(*this);
  std::optional<CellKey> found;
  walk(from, to, storage_->resolution_m, [&](PackedCell p) {
    if (reader.at(p) != Cell::free) found = unpack(p);
    return !found;
  });
  // An invalid end (not finite, far outside the world) cannot be reached by a walk, and is not free.
  if (!found && !in_world(key_of(to))) found = key_of(to);
  if (!found && !in_world(key_of(from))) found = key_of(from);
  return found;
}

std::optional<CellKey> VoxelMap::first_occupied(const Vec3& from, const Vec3& to) const {
  VoxelReader reader(*this);
  std::optional<CellKey> found;
  walk(from, to, storage_->resolution_m, [&](PackedCell p) {
    const Cell cell = reader.at(p);
    if (cell == Cell::occupied) found = unpack(p);
    return !found && (cell != Cell::unknown || in_world(unpack(p)));
  });
  return found;
}

void VoxelMap::for_each_known(const std::function<void(const CellKey&, Cell, float)>& f) const {
  for (const Block* b : storage_->blocks.sorted()) {
    const CellKey corner = corner_of(b->id);
    for (std::uint32_t i = 0; i < b->log_odds.size(); ++i) {
      const std::int16_t v = b->log_odds[i];
      if (v != kUnknown) f(cell_in(corner, i), class_of(v), static_cast<float>(v) / kLogOddsScale);
    }
  }
}

void VoxelMap::for_each_in_box(const CellKey& low, const CellKey& high,
                               const std::function<void(const CellKey&, Cell)>& f) const {
  for (const Block* b : blocks_in_box(storage_->blocks, low, high)) {
    const CellKey c = corner_of(b->id);
    const CellKey from{std::max(c.x, low.x), std::max(c.y, low.y), std::max(c.z, low.z)};
    const CellKey to{std::min(c.x + 7, high.x), std::min(c.y + 7, high.y), std::min(c.z + 7, high.z)};
    for (std::int32_t z = from.z; z <= to.z; ++z)
      for (std::int32_t y = from.y; y <= to.y; ++y)
        for (std::int32_t x = from.x; x <= to.x; ++x) {
          const Cell cell = class_of(b->log_odds[local_of({x, y, z})]);
          if (cell != Cell::unknown) f({x, y, z}, cell);
        }
  }
}

void traverse(const Vec3& from, const Vec3& to, double resolution_m,
              const std::function<bool(const CellKey&)>& visit) {
  walk(from, to, resolution_m, [&](PackedCell p) { return visit(unpack(p)); });
}

}  // namespace karst::core
