// The host's services over a drawn map: slow, simple, and complete.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <karst/testing/drawn_map.h>
#include <karst/testing/drawn_passages.h>
#include <karst/testing/drawn_survey.h>

namespace karst::testing {

/// Fills the error, if there is one to fill; returns the code.
inline std::int32_t refuse(karst_error_t* error, std::int32_t code, std::string_view text) noexcept {
  if (error == nullptr) return code;
  error->code = code;
  error->text[text.copy(error->text, KARST_ERROR_TEXT_SIZE - 1)] = '\0';
  return code;
}

/// Also a reference for the meaning of each service: see karst_abi_services.h.
class DrawnHost {
 public:
  explicit DrawnHost(DrawnMap map) : map_(std::move(map)) {
    map_service_ = {sizeof map_service_, 0,       &info,    &cell_states,       &cast_rays, &count_in_boxes,
                    &surface_cells,      &retain, &release, &distances_to_rock, &passages,  &passages_at};
    path_service_ = {sizeof path_service_, 0, &lengths, &paths};
    gain_service_ = {sizeof gain_service_, 0, &newly_seen};
    draw_service_ = {sizeof draw_service_, 0, &draw_points, &draw_lines, &draw_text};
    survey_service_ = {sizeof survey_service_, 0, &survey_legs, &survey_leads, &survey_distances};
    host_ = {sizeof host_,   KARST_ABI_MINOR, this, &map_service_, &path_service_,
             &gain_service_, &draw_service_,  &log, &random,       &now,
             &should_stop,   &extension};
  }
  DrawnHost(const DrawnHost&) = delete;
  DrawnHost& operator=(const DrawnHost&) = delete;

  const karst_host_t* host() const { return &host_; }
  const karst_map_t* map_handle() const { return reinterpret_cast<const karst_map_t*>(this); }
  const DrawnMap& map() const { return map_; }
  std::int64_t now_ns = 0;
  Vec3 start;                  // of the mission: from where passages are found
  double max_speed_mps = 2.0;  // for the flight times of paths
  std::optional<DrawnSurvey> survey;
  std::vector<std::string> log_lines;
  std::size_t drawings = 0;

 private:
  static DrawnHost& self(const karst_host_t* h) { return *static_cast<DrawnHost*>(h->context); }
  static std::int32_t too_many(karst_error_t* e) noexcept {
    return refuse(e, KARST_ERROR_LIMIT, "more items than one call takes");
  }

  static std::int32_t info(const karst_host_t* h, const karst_map_t*, karst_map_info_t* out,
                           karst_error_t*) noexcept {
    const DrawnMap& m = self(h).map_;
    *out = {m.resolution_m(), 1, 0, 0};
    for (const auto& [index, cell] : m.known())
      ++(cell == Cell::free ? out->free_cells : out->occupied_cells);
    return KARST_OK;
  }
  static std::int32_t cell_states(const karst_host_t* h, const karst_map_t*, const karst_vec3_t* points,
                                  std::uint64_t count, karst_cell_t* out, karst_error_t* e) noexcept {
    if (count > KARST_MAX_BATCH) return too_many(e);
    for (std::uint64_t i = 0; i < count; ++i)
      out[i] = static_cast<karst_cell_t>(self(h).map_.at(Vec3(points[i])));
    return KARST_OK;
  }

  /// The share of the line from `from` to `to` after which it is outside the box for good.
  static double share_until_left(const Box& box, const Vec3& from, const Vec3& to) {
    double share = 1;
    const auto leaves = [&share](double low, double high, double a, double b) {
      if (a != b) share = std::min(share, ((b > a ? high : low) - a) / (b - a));
    };
    leaves(box.low.x, box.high.x, from.x, to.x);
    leaves(box.low.y, box.high.y, from.y, to.y);
    leaves(box.low.z, box.high.z, from.z, to.z);
    return std::max(share, 0.0);
  }
  /// The first cell that stops the ray from `from` to `to`, found in steps of a hundredth of a cell. Steps
  /// that stay in a cell are left out, and those after the share `known_share` of the ray, where nothing is
  /// known.
  static karst_ray_end_t cast(const DrawnMap& m, const Vec3& from, const Vec3& to, bool through_unknown,
                              double known_share = 1) {
    const int steps = static_cast<int>(std::ceil(distance(from, to) / (0.01 * m.resolution_m())));
    karst_ray_end_t end{};
    for (int i = 0;;) {
      const Index at = m.index_of(from + (steps == 0 ? 0.0 : static_cast<double>(i) / steps) * (to - from));
      const Cell c = m.at(at);
      end.center = m.center_of(at);
      end.length_m = distance(from, m.center_of(at));
      end.state = static_cast<karst_cell_t>(Cell::free);
      if (c == Cell::occupied || (c == Cell::unknown && !through_unknown)) {
        end.state = static_cast<karst_cell_t>(c);
        return end;
      }
      if (i == steps) return end;
      const Box cell = box_around(end.center, 0.5 * m.resolution_m());
      const int last_inside =
          static_cast<int>(share_until_left(cell, from, to) * steps) - 1;  // but for rounding
      i = std::min(std::max(i + 1, last_inside), steps);
      if (through_unknown && i > known_share * steps) i = steps;
    }
  }
  static std::int32_t cast_rays(const karst_host_t* h, const karst_map_t*, const karst_segment_t* rays,
                                std::uint64_t count, std::uint32_t flags, karst_ray_end_t* out,
                                karst_error_t* e) noexcept {
    if (count > KARST_MAX_BATCH) return too_many(e);
    for (std::uint64_t i = 0; i < count; ++i)
      out[i] = cast(self(h).map_, rays[i].from, rays[i].to, (flags & KARST_RAY_THROUGH_UNKNOWN) != 0);
    return KARST_OK;
  }

  /// Calls visit(index) for each cell whose centre lies in the box.
  template <class Visit>
  static void for_each_in(const DrawnMap& m, const karst_box_t& box, Visit&& visit) {
    const Index low = m.index_of(box.low), high = m.index_of(box.high);
    const auto in = [](double v, double a, double b) { return v >= a && v <= b; };
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const Vec3 c = m.center_of({x, y, z});
          if (in(c.x, box.low.x, box.high.x) && in(c.y, box.low.y, box.high.y) &&
              in(c.z, box.low.z, box.high.z))
            visit(Index{x, y, z});
        }
  }
  static std::int32_t count_in_boxes(const karst_host_t* h, const karst_map_t*, const karst_box_t* boxes,
                                     std::uint64_t count, karst_cell_counts_t* out,
                                     karst_error_t* e) noexcept {
    if (count > KARST_MAX_BATCH) return too_many(e);
    const DrawnMap& m = self(h).map_;
    for (std::uint64_t i = 0; i < count; ++i) {
      out[i] = {};
      for_each_in(m, boxes[i], [&](const Index& k) {
        const Cell c = m.at(k);
        ++(c == Cell::free ? out[i].free : c == Cell::occupied ? out[i].occupied : out[i].unknown);
      });
    }
    return KARST_OK;
  }
  static bool holds(const karst_box_t& b, const Vec3& p) {
    return p.x >= b.low.x && p.x <= b.high.x && p.y >= b.low.y && p.y <= b.high.y && p.z >= b.low.z &&
           p.z <= b.high.z;
  }
  static std::int32_t surface_cells(const karst_host_t* h, const karst_map_t*, karst_box_t box,
                                    karst_vec3_t* out, std::uint64_t capacity, std::uint64_t* total,
                                    karst_error_t*) noexcept {
    const DrawnMap& m = self(h).map_;
    std::vector<Index> surface;
    for (const auto& [k, cell] : m.known()) {  // a box may be far larger than the drawing
      if (cell != Cell::occupied || !holds(box, m.center_of(k))) continue;
      const Index faces[] = {{k.x - 1, k.y, k.z}, {k.x + 1, k.y, k.z}, {k.x, k.y - 1, k.z},
                             {k.x, k.y + 1, k.z}, {k.x, k.y, k.z - 1}, {k.x, k.y, k.z + 1}};
      if (std::any_of(std::begin(faces), std::end(faces),
                      [&](const Index& f) { return m.at(f) == Cell::free; }))
        surface.push_back(k);
    }
    std::sort(surface.begin(), surface.end(), [](const Index& a, const Index& b) {
      return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
    });
    *total = surface.size();
    for (std::size_t i = 0; i < surface.size() && i < capacity; ++i) out[i] = m.center_of(surface[i]);
    return KARST_OK;
  }
  static std::int32_t distances_to_rock(const karst_host_t* h, const karst_map_t*, const karst_vec3_t* points,
                                        std::uint64_t count, double limit_m, double* out,
                                        karst_error_t* e) noexcept {
    if (count > KARST_MAX_BATCH) return too_many(e);
    if (!(limit_m > 0 && limit_m <= KARST_MAX_ROCK_DISTANCE_M))
      return refuse(e, KARST_ERROR_ARGUMENT, "limit_m is not in (0, 100] m");
    for (std::uint64_t i = 0; i < count; ++i)
      out[i] = distance_to_cell(self(h).map_, points[i], limit_m, [](Cell c) { return c == Cell::occupied; });
    return KARST_OK;
  }
  static std::int32_t passages(const karst_host_t* h, const karst_map_t*, karst_passage_t* passages,
                               std::uint64_t passage_capacity, std::uint64_t* passage_total,
                               karst_passage_end_t* ends, std::uint64_t end_capacity,
                               std::uint64_t* end_total, karst_error_t*) noexcept {
    const DrawnPassages found = find_passages(self(h).map_, self(h).start);
    *passage_total = found.passages.size();
    *end_total = found.ends.size();
    for (std::size_t i = 0; i < found.passages.size() && i < passage_capacity; ++i)
      passages[i] = found.passages[i];
    for (std::size_t i = 0; i < found.ends.size() && i < end_capacity; ++i) ends[i] = found.ends[i];
    return KARST_OK;
  }
  static std::int32_t passages_at(const karst_host_t* h, const karst_map_t*, const karst_vec3_t* points,
                                  std::uint64_t count, karst_passage_place_t* out,
                                  karst_error_t* e) noexcept {
    if (count > KARST_MAX_BATCH) return too_many(e);
    const DrawnPassages found = find_passages(self(h).map_, self(h).start);
    for (std::uint64_t i = 0; i < count; ++i) out[i] = passage_at(self(h).map_, found, points[i]);
    return KARST_OK;
  }
  static const karst_map_t* retain(const karst_host_t*, const karst_map_t* map, karst_error_t*) noexcept {
    return map;  // a drawn map never changes
  }
  static void release(const karst_host_t*, const karst_map_t*) noexcept {}

  static std::int32_t lengths(const karst_host_t* h, karst_vec3_t from, const karst_vec3_t* goals,
                              std::uint64_t count, double, double* out, karst_error_t* e) noexcept {
    if (count > KARST_MAX_PATH_GOALS) return too_many(e);
    for (std::uint64_t i = 0; i < count; ++i) out[i] = self(h).map_.path_length_m(from, goals[i]);
    return KARST_OK;
  }

  /// Distance from `p` to the nearest centre of a cell for which `stops(cell)` holds, at most `limit_m`.
  /// Looks at cubes of cells around p's own, from the inside out.
  template <class Stops>
  static double distance_to_cell(const DrawnMap& m, const Vec3& p, double limit_m, Stops&& stops) {
    const Index own = m.index_of(p);
    const int most = static_cast<int>(std::ceil(limit_m / m.resolution_m()));
    double best = limit_m;
    for (int r = 0; r <= most && best > (r - 0.5) * m.resolution_m(); ++r)
      for (int x = -r; x <= r; ++x)
        for (int y = -r; y <= r; ++y)
          for (int z = -r; z <= r; ++z) {
            if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != r) continue;
            const Index k{own.x + x, own.y + y, own.z + z};
            if (stops(m.at(k))) best = std::min(best, distance(p, m.center_of(k)));
          }
    return best;
  }
  static double least_clearance_m(const DrawnMap& m, const std::vector<Vec3>& points) {
    double least = 15 * m.resolution_m();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 before = points[i == 0 ? 0 : i - 1], along = points[i] - before;
      const int steps = 1 + static_cast<int>(norm(along) / (0.25 * m.resolution_m()));
      for (int k = 1; k <= steps; ++k)
        least = distance_to_cell(m, before + (static_cast<double>(k) / steps) * along, least,
                                 [](Cell c) { return c != Cell::free; });
    }
    return least;
  }
  /// As the host estimates it up to 2 m/s: cruises at 0.8 of the maximum, and speeds up and brakes at 2
  /// m/s^2.
  static double flight_time_s(double length_m, double speed_mps) {
    const double cruise = 0.8 * speed_mps, a = 2.0;
    return length_m >= cruise * cruise / a ? length_m / cruise + cruise / a : 2 * std::sqrt(length_m / a);
  }
  static std::int32_t paths(const karst_host_t* h, karst_vec3_t from, const karst_vec3_t* goals,
                            std::uint64_t count, double, karst_path_t* out, karst_vec3_t* points,
                            std::uint64_t capacity, karst_error_t* e) noexcept {
    if (count > KARST_MAX_PATHS) return too_many(e);
    const DrawnHost& drawn = self(h);
    std::uint64_t total = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::vector<Vec3> found = drawn.map_.route(from, goals[i]).points;
      double length_m = found.empty() ? std::numeric_limits<double>::infinity() : 0.0;
      for (std::size_t k = 0; k < found.size(); ++k) {
        if (k > 0) length_m += distance(found[k - 1], found[k]);
        if (total < capacity) points[total] = found[k];
        ++total;
      }
      out[i] = {length_m, found.empty() ? 0.0 : least_clearance_m(drawn.map_, found),
                found.empty() ? length_m : flight_time_s(length_m, drawn.max_speed_mps), total};
    }
    return KARST_OK;
  }

  /// Whether the direction, in the sensor's frame, is within its field of view.
  static bool in_view(const karst_sensor_t& s, const Vec3& d) {
    const double azimuth = std::atan2(d.y, d.x);
    const bool is_camera = s.kind == KARST_SENSOR_CAMERA || s.kind == KARST_SENSOR_RGB;
    if (is_camera && d.x <= 0) return false;
    const double flat = is_camera ? d.x : std::hypot(d.x, d.y);
    const double elevation = std::atan2(d.z, flat);
    return std::abs(azimuth) <= 0.5 * s.horizontal_fov_rad && elevation >= s.low_elevation_rad &&
           elevation <= s.high_elevation_rad;
  }
  static Vec3 rotated(const karst_quaternion_t& q, const Vec3& v) {
    const Vec3 u{q.x, q.y, q.z};
    const auto cross = [](const Vec3& a, const Vec3& b) {
      return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    };
    const Vec3 t = 2.0 * cross(u, v);
    return v + q.w * t + cross(u, t);
  }
  /// Counts the unknown cells in range and in view that have no occupied cell on the line to their centre.
  static std::uint64_t count_seen(const DrawnMap& m, const karst_sensor_t& s, const karst_viewpoint_t& v) {
    const double c = std::cos(v.heading_rad), w = std::sin(v.heading_rad);
    const Vec3 p = s.T_body_sensor.position;
    const Vec3 eye = Vec3(v.position) + Vec3(c * p.x - w * p.y, w * p.x + c * p.y, p.z);
    const karst_quaternion_t q = s.T_body_sensor.orientation;
    std::uint64_t count = 0;
    const Box around = box_around(eye, s.max_range_m), drawing = m.bounds();
    for_each_in(m, {around.low, around.high}, [&](const Index& k) {
      const Vec3 there = m.center_of(k), away = there - eye;
      if (m.at(k) != Cell::unknown || norm(away) < s.min_range_m || norm(away) > s.max_range_m) return;
      const Vec3 body{c * away.x + w * away.y, -w * away.x + c * away.y, away.z};
      if (!in_view(s, rotated({q.w, -q.x, -q.y, -q.z}, body))) return;
      const double known_share = share_until_left(drawing, eye, there);
      if (cast(m, eye, there, true, known_share).state == static_cast<karst_cell_t>(Cell::free)) ++count;
    });
    return count;
  }
  static std::int32_t newly_seen(const karst_host_t* h, const karst_map_t*, const karst_sensor_t* sensors,
                                 std::uint64_t sensor_count, const karst_viewpoint_t* viewpoints,
                                 std::uint64_t count, std::uint64_t* out, karst_error_t* e) noexcept {
    if (sensor_count > 16 || count > KARST_MAX_GAIN_VIEWPOINTS) return too_many(e);
    for (std::uint64_t i = 0; i < count; ++i)
      for (std::uint64_t j = 0; j < sensor_count; ++j)
        out[i * sensor_count + j] = count_seen(self(h).map_, sensors[j], viewpoints[i]);
    return KARST_OK;
  }

  static std::int32_t draw_points(const karst_host_t* h, const karst_vec3_t*, std::uint64_t, std::uint32_t,
                                  karst_error_t*) noexcept {
    ++self(h).drawings;
    return KARST_OK;
  }
  static std::int32_t draw_lines(const karst_host_t* h, const karst_segment_t*, std::uint64_t, std::uint32_t,
                                 karst_error_t*) noexcept {
    ++self(h).drawings;
    return KARST_OK;
  }
  static std::int32_t draw_text(const karst_host_t* h, karst_vec3_t, karst_text_t, std::uint32_t,
                                karst_error_t*) noexcept {
    ++self(h).drawings;
    return KARST_OK;
  }
  static void log(const karst_host_t* h, std::uint32_t, karst_text_t text) noexcept {
    self(h).log_lines.push_back(from_abi(text));
  }
  /// A linear congruential generator (Knuth's MMIX constants), the same in every run.
  static void random(const karst_host_t* h, double* out, std::uint64_t count) noexcept {
    std::uint64_t& s = self(h).chance_;
    for (std::uint64_t i = 0; i < count; ++i) {
      s = s * 6364136223846793005ull + 1442695040888963407ull;
      out[i] = static_cast<double>(s >> 11) / 9007199254740992.0;
    }
  }
  static std::int64_t now(const karst_host_t* h) noexcept { return self(h).now_ns; }
  static std::uint32_t should_stop(const karst_host_t*) noexcept { return 0; }
  static const void* extension(const karst_host_t* h, karst_text_t id) noexcept {
    const std::string_view asked(id.data == nullptr ? "" : id.data, id.data == nullptr ? 0 : id.length);
    return asked == KARST_SURVEY_ID ? &self(h).survey_service_ : nullptr;
  }

  static std::int32_t no_survey(karst_error_t* e) noexcept {
    return refuse(e, KARST_ERROR_UNAVAILABLE, "the mission has no survey");
  }
  template <class Item>
  static void copy(const std::vector<Item>& items, Item* out, std::uint64_t capacity, std::uint64_t* total) {
    *total = items.size();
    for (std::size_t i = 0; i < items.size() && i < capacity; ++i) out[i] = items[i];
  }
  static std::int32_t survey_legs(const karst_host_t* h, karst_survey_leg_t* out, std::uint64_t capacity,
                                  std::uint64_t* total, karst_error_t* e) noexcept {
    if (!self(h).survey) return no_survey(e);
    copy(self(h).survey->legs, out, capacity, total);
    return KARST_OK;
  }
  static std::int32_t survey_leads(const karst_host_t* h, karst_survey_lead_t* out, std::uint64_t capacity,
                                   std::uint64_t* total, karst_error_t* e) noexcept {
    if (!self(h).survey) return no_survey(e);
    copy(self(h).survey->leads, out, capacity, total);
    return KARST_OK;
  }
  static std::int32_t survey_distances(const karst_host_t* h, const karst_vec3_t* points, std::uint64_t count,
                                       double* out, karst_error_t* e) noexcept {
    if (count > KARST_MAX_BATCH) return too_many(e);
    if (!self(h).survey) return no_survey(e);
    for (std::uint64_t i = 0; i < count; ++i) out[i] = self(h).survey->distance_m(points[i]);
    return KARST_OK;
  }

  DrawnMap map_;
  std::uint64_t chance_ = 1;
  karst_map_service_t map_service_{};
  karst_path_service_t path_service_{};
  karst_gain_service_t gain_service_{};
  karst_draw_service_t draw_service_{};
  karst_survey_service_t survey_service_{};
  karst_host_t host_{};
};

}  // namespace karst::testing
