// The functions behind the service tables. Each checks its arguments, then works through the session's gate.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core_stack/homing/path_home/home.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "sdk/host/services/gain.h"
#include "sdk/host/services/serving.h"

namespace karst::host {
struct Services : Serving {
  static const Snapshot& snapshot(Session& s, const karst_map_t* map) {
    const Snapshot* found = s.find(map);
    if (found == nullptr)
      throw Refusal{KARST_ERROR_STATE,
                    "no such map: a request's map lives until decide() returns, unless retained"};
    return *found;
  }

  // map

  static std::int32_t info(const karst_host_t* h, const karst_map_t* m, karst_map_info_t* out,
                           karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require(out != nullptr, "out is NULL");
      *out = info_of(snapshot(s, m));
    });
  }

  static std::int32_t cell_states(const karst_host_t* h, const karst_map_t* m, const karst_vec3_t* points,
                                  std::uint64_t count, karst_cell_t* out, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, points, out);
      const core::VoxelMap& map = *snapshot(s, m).map;
      core::VoxelReader reader(map);
      for (std::uint64_t i = 0; i < count; ++i) {
        require(finite(points[i]), "a point is not finite");
        out[i] = static_cast<karst_cell_t>(reader.at(map.key_of(to_core(points[i]))));
      }
    });
  }

  static std::int32_t cast_rays(const karst_host_t* h, const karst_map_t* m, const karst_segment_t* rays,
                                std::uint64_t count, std::uint32_t flags, karst_ray_end_t* out,
                                karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, rays, out);
      const core::VoxelMap& map = *snapshot(s, m).map;
      for (std::uint64_t i = 0; i < count; ++i) {
        check_not_abandoned(s);
        require(finite(rays[i].from) && finite(rays[i].to), "a ray is not finite");
        require((to_core(rays[i].to) - to_core(rays[i].from)).norm() <= KARST_MAX_RAY_LENGTH_M,
                "a ray is longer than 1000 m");
        out[i] = cast_ray(map, rays[i], (flags & KARST_RAY_THROUGH_UNKNOWN) != 0);
      }
    });
  }

  static std::int32_t count_in_boxes(const karst_host_t* h, const karst_map_t* m, const karst_box_t* boxes,
                                     std::uint64_t count, karst_cell_counts_t* out,
                                     karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, boxes, out);
      const core::VoxelMap& map = *snapshot(s, m).map;
      for (std::uint64_t i = 0; i < count; ++i) {
        check_not_abandoned(s);
        require_box(boxes[i]);
        const std::optional<karst_cell_counts_t> counts = count_in_box(map, boxes[i]);
        if (!counts) throw Refusal{KARST_ERROR_LIMIT, "a box holds 2^63 cells or more"};
        out[i] = *counts;
      }
    });
  }

  static std::int32_t surface_cells(const karst_host_t* h, const karst_map_t* m, karst_box_t box,
                                    karst_vec3_t* out, std::uint64_t capacity, std::uint64_t* total,
                                    karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require(total != nullptr && (capacity == 0 || out != nullptr), "an array is NULL");
      require_box(box);
      const std::vector<karst_vec3_t> cells = surface_in_box(*snapshot(s, m).map, box);
      *total = cells.size();
      std::copy_n(cells.begin(), std::min<std::uint64_t>(capacity, cells.size()), out);
    });
  }

  static std::int32_t distances_to_rock(const karst_host_t* h, const karst_map_t* m,
                                        const karst_vec3_t* points, std::uint64_t count, double limit_m,
                                        double* out, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, points, out);
      require(limit_m > 0 && limit_m <= KARST_MAX_ROCK_DISTANCE_M, "limit_m is not in (0, 100] m");
      const core::VoxelMap& map = *snapshot(s, m).map;
      core::WorkBudget work(kMaxRockWork);
      for (std::uint64_t i = 0; i < count; ++i) {
        check_not_abandoned(s);
        require(finite(points[i]), "a point is not finite");
        require(to_core(points[i]).norm() <= 1e5, "a point is more than 100 km away");
        const std::optional<double> distance_m = distance_to_rock(map, to_core(points[i]), limit_m, work);
        if (!distance_m)
          throw Refusal{KARST_ERROR_LIMIT,
                        "so many points cannot be searched so far around: ask for fewer at a time, or with a "
                        "smaller limit_m"};
        out[i] = *distance_m;
      }
    });
  }

  static const core::PassageMap& passages_of(const Snapshot& snapshot) {
    const core::PassageMap* found = snapshot.passages->answer(*snapshot.map, snapshot.start);
    if (found == nullptr)
      throw Refusal{KARST_ERROR_LIMIT,
                    "the map is too large: its passages cannot be found in about a second"};
    return *found;
  }

  static std::int32_t passages(const karst_host_t* h, const karst_map_t* m, karst_passage_t* passages,
                               std::uint64_t passage_capacity, std::uint64_t* passage_total,
                               karst_passage_end_t* ends, std::uint64_t end_capacity,
                               std::uint64_t* end_total, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require(passage_total != nullptr && end_total != nullptr, "a total is NULL");
      require((passage_capacity == 0 || passages != nullptr) && (end_capacity == 0 || ends != nullptr),
              "an array is NULL");
      const core::PassageMap& found = passages_of(snapshot(s, m));
      *passage_total = found.passages.size();
      *end_total = found.ends.size();
      for (std::uint64_t i = 0; i < std::min(passage_capacity, *passage_total); ++i)
        passages[i] = to_abi(found.passages[i]);
      for (std::uint64_t i = 0; i < std::min(end_capacity, *end_total); ++i) ends[i] = to_abi(found.ends[i]);
    });
  }

  static std::int32_t passages_at(const karst_host_t* h, const karst_map_t* m, const karst_vec3_t* points,
                                  std::uint64_t count, karst_passage_place_t* out,
                                  karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, points, out);
      const core::PassageMap& found = passages_of(snapshot(s, m));
      for (std::uint64_t i = 0; i < count; ++i) {
        check_not_abandoned(s);
        require(finite(points[i]), "a point is not finite");
        out[i] = to_abi(found.at(to_core(points[i])));
      }
    });
  }

  static const karst_map_t* retain(const karst_host_t* h, const karst_map_t* m, karst_error_t* e) noexcept {
    const karst_map_t* kept = nullptr;
    serve(h, e, [&](Session& s) {
      on_decision_thread(s);
      std::unique_ptr<Snapshot> copy = copy_of(snapshot(s, m));
      const auto* handle = reinterpret_cast<const karst_map_t*>(copy.get());
      const std::lock_guard lock(s.kept_mutex_);
      s.kept_.emplace(handle, std::move(copy));
      kept = handle;
    });
    return kept;
  }

  static void release(const karst_host_t* h, const karst_map_t* m) noexcept {
    serve(h, nullptr, [&](Session& s) {
      const std::lock_guard lock(s.kept_mutex_);
      s.kept_.erase(m);
    });
  }

  // path

  static std::vector<core::Vec3> places_of(karst_vec3_t from, const karst_vec3_t* goals, std::uint64_t count,
                                           double tolerance_m) {
    require(finite(from), "from is not finite");
    require(tolerance_m >= 0 && tolerance_m <= 100, "tolerance_m is not in [0, 100] m");
    std::vector<core::Vec3> places;
    for (std::uint64_t i = 0; i < count; ++i) {
      require(finite(goals[i]), "a goal is not finite");
      places.push_back(to_core(goals[i]));
    }
    return places;
  }
  static Refusal closed() { return {KARST_ERROR_STATE, "paths can be asked for during decide() only"}; }

  static std::int32_t lengths(const karst_host_t* h, karst_vec3_t from, const karst_vec3_t* goals,
                              std::uint64_t count, double tolerance_m, double* out,
                              karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_PATH_GOALS, goals, out);
      const std::vector<core::Vec3> places = places_of(from, goals, count, tolerance_m);
      if (s.live_.map == nullptr || !s.lengths_) throw closed();
      const PathAnswer found = s.lengths_(to_core(from), places, tolerance_m);
      if (found.status == PathAnswer::Status::too_much)
        throw Refusal{KARST_ERROR_LIMIT,
                      "so many goals that are not clear cannot be searched so far around: ask for fewer at a "
                      "time, or with less tolerance"};
      if (found.status != PathAnswer::Status::answered || found.lengths_m.size() != count) throw closed();
      std::copy(found.lengths_m.begin(), found.lengths_m.end(), out);
    });
  }

  static std::int32_t paths(const karst_host_t* h, karst_vec3_t from, const karst_vec3_t* goals,
                            std::uint64_t count, double tolerance_m, karst_path_t* out, karst_vec3_t* points,
                            std::uint64_t capacity, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_PATHS, goals, out);
      require(capacity == 0 || points != nullptr, "an array is NULL");
      const std::vector<core::Vec3> places = places_of(from, goals, count, tolerance_m);
      if (s.live_.map == nullptr || !s.paths_) throw closed();
      const PathsAnswer found = s.paths_(to_core(from), places, tolerance_m);
      if (found.status == PathAnswer::Status::too_much)
        throw Refusal{KARST_ERROR_LIMIT,
                      "so many paths cannot be searched in a map so large: ask for fewer at a time, or with "
                      "less tolerance"};
      if (found.status != PathAnswer::Status::answered || found.paths.size() != count) throw closed();
      std::uint64_t total = 0;
      for (std::uint64_t i = 0; i < count; ++i) {
        const FoundPath& path = found.paths[i];
        for (const core::Vec3& p : path.points) {
          if (total < capacity) points[total] = to_abi(p);
          ++total;
        }
        const double time_s = path.points.empty() ? path.length_m  // no path: infinite, too
                                                  : core::flight_time_s(path.length_m, s.motion_);
        out[i] = {path.length_m, path.clearance_m, time_s, total};
      }
    });
  }

  // gain

  static std::int32_t newly_seen(const karst_host_t* h, const karst_map_t* m, const karst_sensor_t* sensors,
                                 std::uint64_t sensor_count, const karst_viewpoint_t* viewpoints,
                                 std::uint64_t count, std::uint64_t* out, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(sensor_count, 16, sensors, out);
      require_batch(count, KARST_MAX_GAIN_VIEWPOINTS, viewpoints, out);
      const core::VoxelMap& map = *snapshot(s, m).map;
      for (std::uint64_t j = 0; j < sensor_count; ++j) {
        if (const std::string fault = sensor_fault(sensors[j]); !fault.empty())
          throw Refusal{KARST_ERROR_ARGUMENT, "sensor " + std::to_string(j) + ": " + fault};
        if (const std::string excess = sensor_excess(sensors[j], map.resolution_m()); !excess.empty())
          throw Refusal{KARST_ERROR_LIMIT, "sensor " + std::to_string(j) + ": " + excess};
        SensorRays rays(sensors[j], map.resolution_m());
        for (std::uint64_t i = 0; i < count; ++i) {
          check_not_abandoned(s);
          require(finite(viewpoints[i].position) && std::isfinite(viewpoints[i].heading_rad),
                  "a viewpoint is not finite");
          require(to_core(viewpoints[i].position).norm() <= 1e5, "a viewpoint is more than 100 km away");
          out[i * sensor_count + j] = rays.newly_seen(map, viewpoints[i]);
        }
      }
    });
  }

  // draw

  static void add_drawing(Session& s, core::Drawing drawing) {
    constexpr std::size_t max_points = 200'000, max_drawings = 1000;  // between two decisions
    on_decision_thread(s);
    for (const core::Vec3& p : drawing.points) require(p.allFinite(), "a point is not finite");
    const std::lock_guard lock(s.output_mutex_);
    if (s.drawn_points_ + drawing.points.size() > max_points || s.drawings_.size() >= max_drawings)
      throw Refusal{KARST_ERROR_LIMIT, "more is drawn than the report holds"};
    s.drawn_points_ += drawing.points.size();
    s.drawings_.push_back(std::move(drawing));
  }

  static std::int32_t points(const karst_host_t* h, const karst_vec3_t* points, std::uint64_t count,
                             std::uint32_t rgb, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, points, points);
      core::Drawing d{core::Drawing::Kind::points, {}, rgb & 0xffffffu, ""};
      for (std::uint64_t i = 0; i < count; ++i) d.points.push_back(to_core(points[i]));
      add_drawing(s, std::move(d));
    });
  }

  static std::int32_t lines(const karst_host_t* h, const karst_segment_t* lines, std::uint64_t count,
                            std::uint32_t rgb, karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      require_batch(count, KARST_MAX_BATCH, lines, lines);
      core::Drawing d{core::Drawing::Kind::lines, {}, rgb & 0xffffffu, ""};
      for (std::uint64_t i = 0; i < count; ++i) {
        d.points.push_back(to_core(lines[i].from));
        d.points.push_back(to_core(lines[i].to));
      }
      add_drawing(s, std::move(d));
    });
  }

  static std::int32_t text(const karst_host_t* h, karst_vec3_t at, karst_text_t text, std::uint32_t rgb,
                           karst_error_t* e) noexcept {
    return serve(h, e, [&](Session& s) {
      add_drawing(s, {core::Drawing::Kind::text, {to_core(at)}, rgb & 0xffffffu, cleaned(text, kLineLimit)});
    });
  }

  // the host's own

  static void log(const karst_host_t* h, std::uint32_t level, karst_text_t text) noexcept {
    serve(h, nullptr, [&](Session& s) {
      s.note((level >= KARST_LOG_WARNING ? "warning: " : "") + cleaned(text, kLogLineLimit));
    });
  }

  static void random(const karst_host_t* h, double* out, std::uint64_t count) noexcept {
    if (out == nullptr) return;
    const std::int32_t code = serve(h, nullptr, [&](Session& s) {
      on_decision_thread(s);
      for (std::uint64_t i = 0; i < count; ++i) {
        if (i % KARST_MAX_BATCH == 0) check_not_abandoned(s);
        out[i] = s.random_.uniform();
      }
      s.numbers_drawn_ += count;
    });
    if (code != KARST_OK) std::fill_n(out, count, 0.5);  // the same in every run
  }

  static std::int64_t now_ns(const karst_host_t* h) noexcept { return session(h).now_; }
  static std::uint32_t should_stop(const karst_host_t* h) noexcept { return session(h).abandoned_ ? 1u : 0u; }
  static const void* extension(const karst_host_t*, karst_text_t id) noexcept {
    const std::string_view asked(id.data == nullptr ? "" : id.data, id.data == nullptr ? 0 : id.length);
    if (asked == KARST_IMAGED_ID) return imaged_service();
    if (asked == KARST_SURVEY_ID) return survey_service();
    return nullptr;
  }

  static void install(Session& s, karst_host_t& host) {
    s.map_service_ = {
        sizeof s.map_service_, 0,       &info,    &cell_states,       &cast_rays, &count_in_boxes,
        &surface_cells,        &retain, &release, &distances_to_rock, &passages,  &passages_at};
    s.path_service_ = {sizeof s.path_service_, 0, &lengths, &paths};
    s.gain_service_ = {sizeof s.gain_service_, 0, &newly_seen};
    s.draw_service_ = {sizeof s.draw_service_, 0, &points, &lines, &text};
    host = {sizeof host,      KARST_ABI_MINOR,  &s,   &s.map_service_, &s.path_service_,
            &s.gain_service_, &s.draw_service_, &log, &random,         &now_ns,
            &should_stop,     &extension};
  }
};

void install_services(Session& session, karst_host_t& host) { Services::install(session, host); }

}  // namespace karst::host
