#include "sdk/check/watched_host.h"

#include <algorithm>
#include <tuple>

#include "sdk/host/boundary/text.h"

namespace karst::check {

struct Wrapped {
  static WatchedHost& watched(const karst_host_t* h) { return *static_cast<WatchedHost*>(h->context); }

  static void arrive(WatchedHost& w) {
    ++w.calls_;
    if (w.closed_) ++w.late_calls_;
  }

  /// Calls `Slot` of the service `Table` on the inner host.
  template <auto Table, auto Slot, class... Args>
  static std::int32_t pass(const char* name, const karst_host_t* h, karst_error_t* e, Args... args) noexcept {
    WatchedHost& w = watched(h);
    arrive(w);
    if (const std::int32_t code = w.before ? w.before(name) : KARST_OK; code != KARST_OK) {
      host::fill_error(e, code, "made to fail by karst policy check");
      return code;
    }
    karst_error_t own{};
    karst_error_t* error = e == nullptr ? &own : e;
    const std::int32_t code = ((w.inner_.*Table)->*Slot)(&w.inner_, args..., error);
    if (code != KARST_OK) note(w, name, *error);
    return code;
  }
  static void note(WatchedHost& w, const char* name, const karst_error_t& e) {
    const std::string line = std::string(name) + ": " + host::text_of(e);
    const std::lock_guard lock(w.mutex_);
    if (std::find(w.refusals_.begin(), w.refusals_.end(), line) == w.refusals_.end())
      w.refusals_.push_back(line);
  }

  static std::int32_t info(const karst_host_t* h, const karst_map_t* m, karst_map_info_t* out,
                           karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::info>("map.info", h, e, m, out);
  }
  static std::int32_t cell_states(const karst_host_t* h, const karst_map_t* m, const karst_vec3_t* points,
                                  std::uint64_t n, karst_cell_t* out, karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::cell_states>("map.cell_states", h, e, m, points, n,
                                                                       out);
  }
  static std::int32_t cast_rays(const karst_host_t* h, const karst_map_t* m, const karst_segment_t* rays,
                                std::uint64_t n, std::uint32_t flags, karst_ray_end_t* out,
                                karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::cast_rays>("map.cast_rays", h, e, m, rays, n, flags,
                                                                     out);
  }
  static std::int32_t count_in_boxes(const karst_host_t* h, const karst_map_t* m, const karst_box_t* boxes,
                                     std::uint64_t n, karst_cell_counts_t* out, karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::count_in_boxes>("map.count_in_boxes", h, e, m,
                                                                          boxes, n, out);
  }
  static std::int32_t surface_cells(const karst_host_t* h, const karst_map_t* m, karst_box_t box,
                                    karst_vec3_t* out, std::uint64_t capacity, std::uint64_t* total,
                                    karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::surface_cells>("map.surface_cells", h, e, m, box,
                                                                         out, capacity, total);
  }
  static const karst_map_t* retain(const karst_host_t* h, const karst_map_t* m, karst_error_t* e) noexcept {
    WatchedHost& w = watched(h);
    arrive(w);
    if (const std::int32_t code = w.before ? w.before("map.retain") : KARST_OK; code != KARST_OK) {
      host::fill_error(e, code, "made to fail by karst policy check");
      return nullptr;
    }
    karst_error_t own{};
    karst_error_t* error = e == nullptr ? &own : e;
    const karst_map_t* kept = w.inner_.map->retain(&w.inner_, m, error);
    if (kept == nullptr) note(w, "map.retain", *error);
    return kept;
  }
  static void release(const karst_host_t* h, const karst_map_t* m) noexcept {
    arrive(watched(h));
    watched(h).inner_.map->release(&watched(h).inner_, m);
  }
  static std::int32_t distances_to_rock(const karst_host_t* h, const karst_map_t* m,
                                        const karst_vec3_t* points, std::uint64_t n, double limit_m,
                                        double* out, karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::distances_to_rock>("map.distances_to_rock", h, e, m,
                                                                             points, n, limit_m, out);
  }
  static std::int32_t passages(const karst_host_t* h, const karst_map_t* m, karst_passage_t* passages,
                               std::uint64_t passage_capacity, std::uint64_t* passage_total,
                               karst_passage_end_t* ends, std::uint64_t end_capacity,
                               std::uint64_t* end_total, karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::passages>(
        "map.passages", h, e, m, passages, passage_capacity, passage_total, ends, end_capacity, end_total);
  }
  static std::int32_t passages_at(const karst_host_t* h, const karst_map_t* m, const karst_vec3_t* points,
                                  std::uint64_t n, karst_passage_place_t* out, karst_error_t* e) noexcept {
    return pass<&karst_host_t::map, &karst_map_service_t::passages_at>("map.passages_at", h, e, m, points, n,
                                                                       out);
  }
  static std::int32_t lengths(const karst_host_t* h, karst_vec3_t from, const karst_vec3_t* goals,
                              std::uint64_t n, double tolerance_m, double* out, karst_error_t* e) noexcept {
    return pass<&karst_host_t::path, &karst_path_service_t::lengths>("path.lengths", h, e, from, goals, n,
                                                                     tolerance_m, out);
  }
  static std::int32_t paths(const karst_host_t* h, karst_vec3_t from, const karst_vec3_t* goals,
                            std::uint64_t n, double tolerance_m, karst_path_t* out, karst_vec3_t* points,
                            std::uint64_t capacity, karst_error_t* e) noexcept {
    return pass<&karst_host_t::path, &karst_path_service_t::paths>("path.paths", h, e, from, goals, n,
                                                                   tolerance_m, out, points, capacity);
  }
  static std::int32_t newly_seen(const karst_host_t* h, const karst_map_t* m, const karst_sensor_t* sensors,
                                 std::uint64_t sensor_count, const karst_viewpoint_t* viewpoints,
                                 std::uint64_t n, std::uint64_t* out, karst_error_t* e) noexcept {
    return pass<&karst_host_t::gain, &karst_gain_service_t::newly_seen>("gain.newly_seen", h, e, m, sensors,
                                                                        sensor_count, viewpoints, n, out);
  }
  static std::int32_t points(const karst_host_t* h, const karst_vec3_t* p, std::uint64_t n, std::uint32_t rgb,
                             karst_error_t* e) noexcept {
    return pass<&karst_host_t::draw, &karst_draw_service_t::points>("draw.points", h, e, p, n, rgb);
  }
  static std::int32_t lines(const karst_host_t* h, const karst_segment_t* l, std::uint64_t n,
                            std::uint32_t rgb, karst_error_t* e) noexcept {
    return pass<&karst_host_t::draw, &karst_draw_service_t::lines>("draw.lines", h, e, l, n, rgb);
  }
  static std::int32_t text(const karst_host_t* h, karst_vec3_t at, karst_text_t text, std::uint32_t rgb,
                           karst_error_t* e) noexcept {
    return pass<&karst_host_t::draw, &karst_draw_service_t::text>("draw.text", h, e, at, text, rgb);
  }
  static void log(const karst_host_t* h, std::uint32_t level, karst_text_t text) noexcept {
    arrive(watched(h));
    watched(h).inner_.log(&watched(h).inner_, level, text);
  }
  static void random(const karst_host_t* h, double* out, std::uint64_t count) noexcept {
    arrive(watched(h));
    watched(h).inner_.random(&watched(h).inner_, out, count);
  }
  static std::int64_t now_ns(const karst_host_t* h) noexcept {
    arrive(watched(h));
    return watched(h).inner_.now_ns(&watched(h).inner_);
  }
  static std::uint32_t should_stop(const karst_host_t* h) noexcept {
    arrive(watched(h));
    return watched(h).stopping ? 1u : watched(h).inner_.should_stop(&watched(h).inner_);
  }
  static const void* extension(const karst_host_t*, karst_text_t) noexcept { return nullptr; }
};

WatchedHost::WatchedHost(const karst_host_t& inner, Offer offer) : inner_(inner) {
  map_ = {sizeof map_,
          0,
          &Wrapped::info,
          &Wrapped::cell_states,
          &Wrapped::cast_rays,
          &Wrapped::count_in_boxes,
          &Wrapped::surface_cells,
          &Wrapped::retain,
          &Wrapped::release,
          &Wrapped::distances_to_rock,
          &Wrapped::passages,
          &Wrapped::passages_at};
  path_ = {sizeof path_, 0, &Wrapped::lengths, &Wrapped::paths};
  gain_ = {sizeof gain_, 0, &Wrapped::newly_seen};
  draw_ = {sizeof draw_, 0, &Wrapped::points, &Wrapped::lines, &Wrapped::text};
  host_ = {sizeof host_,
           inner.abi_minor,
           this,
           &map_,
           offer.path ? &path_ : nullptr,
           offer.gain ? &gain_ : nullptr,
           offer.draw ? &draw_ : nullptr,
           &Wrapped::log,
           &Wrapped::random,
           &Wrapped::now_ns,
           &Wrapped::should_stop,
           &Wrapped::extension};
}

std::vector<std::string> WatchedHost::refusals() const {
  const std::lock_guard lock(mutex_);
  return refusals_;
}

}  // namespace karst::check
