// The occupancy map as a policy sees it. Queries take batches of any size. World frame, metres.
#pragma once
#include <memory>
#include <vector>

#include <karst/chunks.h>
#include <karst/types.h>

namespace karst {

/// A view of the map, valid until decide() returns; `retained()` returns one that lasts. Queries throw Error.
class MapView {
 public:
  MapView() = default;
  MapView(const karst_host_t* host, const karst_map_t* map) : host_(host), map_(map) {}

  karst_map_info_t info() const {
    karst_map_info_t out{};
    karst_error_t e{};
    check(host_->map->info(host_, map_, &out, &e), e);
    return out;
  }
  double resolution_m() const { return info().resolution_m; }

  std::vector<Cell> cells(const std::vector<Vec3>& points) const {
    std::vector<Cell> out(points.size());
    for_chunks(points.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(host_->map->cell_states(host_, map_, points.data() + begin, size,
                                    reinterpret_cast<karst_cell_t*>(out.data() + begin), &e),
            e);
    });
    return out;
  }
  Cell cell(const Vec3& point) const { return cells({point}).front(); }

  std::vector<karst_ray_end_t> cast(const std::vector<karst_segment_t>& rays, bool through_unknown) const {
    std::vector<karst_ray_end_t> out(rays.size());
    const std::uint32_t flags = through_unknown ? std::uint32_t{KARST_RAY_THROUGH_UNKNOWN} : 0u;
    for_chunks(rays.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(host_->map->cast_rays(host_, map_, rays.data() + begin, size, flags, out.data() + begin, &e), e);
    });
    return out;
  }

  std::vector<karst_cell_counts_t> counts(const std::vector<Box>& boxes) const {
    std::vector<karst_box_t> in;
    in.reserve(boxes.size());
    for (const Box& b : boxes) in.push_back({b.low, b.high});
    std::vector<karst_cell_counts_t> out(boxes.size());
    for_chunks(in.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(host_->map->count_in_boxes(host_, map_, in.data() + begin, size, out.data() + begin, &e), e);
    });
    return out;
  }

  /// Centres of the occupied cells in the box that have a free face neighbour.
  std::vector<Vec3> surface(const Box& box) const {
    const karst_box_t in{box.low, box.high};
    std::uint64_t total = 0;
    karst_error_t e{};
    check(host_->map->surface_cells(host_, map_, in, nullptr, 0, &total, &e), e);
    std::vector<Vec3> out(total);
    check(host_->map->surface_cells(host_, map_, in, out.data(), out.size(), &total, &e), e);
    return out;
  }

  /// Metres from each point to the centre of the nearest occupied cell; `limit_m`, in (0, 100], if none is
  /// nearer. Unknown cells are no rock. Far from rock the cost grows with the cube of `limit_m`.
  std::vector<double> distances_to_rock(const std::vector<Vec3>& points, double limit_m) const {
    if (!KARST_HAS(karst_map_service_t, host_->map, distances_to_rock))
      throw Error("this host offers no distances to rock", KARST_ERROR_UNAVAILABLE);
    std::vector<double> out(points.size());
    for_chunks(points.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(host_->map->distances_to_rock(host_, map_, points.data() + begin, size, limit_m,
                                          out.data() + begin, &e),
            e);
    });
    return out;
  }

  /// The passages that are connected to the start of the mission, as far as they are mapped. The host finds
  /// them at the first question about a map, in a twentieth of a second for a million known cells, and keeps
  /// the answer. Throws Error with KARST_ERROR_LIMIT if the map is too large.
  Passages passages() const {
    require_passages();
    std::uint64_t passage_total = 0, end_total = 0;
    karst_error_t e{};
    check(host_->map->passages(host_, map_, nullptr, 0, &passage_total, nullptr, 0, &end_total, &e), e);
    std::vector<karst_passage_t> found(passage_total);
    std::vector<karst_passage_end_t> ends(end_total);
    check(host_->map->passages(host_, map_, found.data(), found.size(), &passage_total, ends.data(),
                               ends.size(), &end_total, &e),
          e);
    Passages out;
    out.passages.reserve(found.size());
    out.ends.reserve(ends.size());
    for (const karst_passage_t& p : found) out.passages.push_back(from_abi(p));
    for (const karst_passage_end_t& end : ends) out.ends.push_back(from_abi(end));
    return out;
  }

  /// The passage or the junction around each point, and how wide and high it is there (metres).
  std::vector<PassagePlace> passages_at(const std::vector<Vec3>& points) const {
    require_passages();
    std::vector<karst_passage_place_t> found(points.size());
    for_chunks(points.size(), KARST_MAX_BATCH, [&](std::size_t begin, std::size_t size) {
      karst_error_t e{};
      check(host_->map->passages_at(host_, map_, points.data() + begin, size, found.data() + begin, &e), e);
    });
    std::vector<PassagePlace> out;
    out.reserve(found.size());
    for (const karst_passage_place_t& p : found) out.push_back(from_abi(p));
    return out;
  }

  /// A copy that outlives the request, released with the last view of it. Costs tens of milliseconds for a
  /// large map; must not outlive the policy object.
  MapView retained() const {
    karst_error_t e{};
    const karst_map_t* kept = host_->map->retain(host_, map_, &e);
    if (kept == nullptr) throw Error(e.text, e.code);
    MapView view(host_, kept);
    view.owner_.reset(kept, [host = host_](const karst_map_t* m) { host->map->release(host, m); });
    return view;
  }

  const karst_map_t* handle() const { return map_; }

 private:
  void require_passages() const {
    if (!KARST_HAS(karst_map_service_t, host_->map, passages) ||
        !KARST_HAS(karst_map_service_t, host_->map, passages_at))
      throw Error("this host offers no passages", KARST_ERROR_UNAVAILABLE);
  }

  const karst_host_t* host_ = nullptr;
  const karst_map_t* map_ = nullptr;
  std::shared_ptr<const karst_map_t> owner_;
};

}  // namespace karst
