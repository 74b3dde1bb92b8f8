// The values that a policy works with. World frame: x east, y north, z up. Metres, seconds, radians.
#pragma once
#include <karst_abi.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace karst {

/// Thrown when a service refuses a call; a policy throws it to give up. The text reaches the mission's log.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& text, std::int32_t code = KARST_ERROR_FAILED)
      : std::runtime_error(text), code_(code) {}
  std::int32_t code() const { return code_; }

 private:
  std::int32_t code_;
};

struct Vec3 : karst_vec3_t {
  constexpr Vec3() : karst_vec3_t{0, 0, 0} {}
  constexpr Vec3(double x_, double y_, double z_) : karst_vec3_t{x_, y_, z_} {}
  constexpr Vec3(const karst_vec3_t& v) : karst_vec3_t(v) {}  // NOLINT: the ABI's vector is this one
};
static_assert(sizeof(Vec3) == sizeof(karst_vec3_t), "arrays of one are arrays of the other");

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, const Vec3& v) { return {s * v.x, s * v.y, s * v.z}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(const Vec3& v) { return std::sqrt(dot(v, v)); }
inline double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }
inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

using Pose = karst_pose_t;  // T_a_b: position and orientation of b in a
using State = karst_state_t;
using Sensor = karst_sensor_t;
using Teammate = karst_teammate_t;
using Viewpoint = karst_viewpoint_t;
struct Box {
  Vec3 low, high;  // closed
};
inline Box box_around(const Vec3& center, double half_edge_m) {
  const Vec3 h{half_edge_m, half_edge_m, half_edge_m};
  return {center - h, center + h};
}

enum class Cell : karst_cell_t {
  unknown = KARST_CELL_UNKNOWN,
  free = KARST_CELL_FREE,
  occupied = KARST_CELL_OCCUPIED
};

/// A group of neighbouring free cells that have an unknown face neighbour.
struct Frontier {
  std::uint32_t id = 0;  // never reused; kept while the cluster shares cells with its last version
  std::uint32_t cells = 0;
  Vec3 centroid, low, high;
  Vec3 normal;                                      // unit, from free into unknown; zero if it has none
  std::uint32_t unknown_cells = 0, free_cells = 0;  // in a box of a few metres around the centroid
  Vec3 viewpoint;                                   // clear, sees the cluster; NaN if none was found
  double viewpoint_heading_rad = 0;
  double path_length_m =
      0;  // from the start of a new path to the viewpoint, in metres; +infinity if no path is known

  bool reachable() const { return is_finite(viewpoint) && std::isfinite(path_length_m); }
};

inline Frontier from_abi(const karst_frontier_cluster_t& c) {
  return {c.id,           c.cells,         c.centroid,   c.bounds.low,         c.bounds.high,
          c.normal,       c.unknown_cells, c.free_cells, c.viewpoint.position, c.viewpoint.heading_rad,
          c.path_length_m};
}
inline karst_frontier_cluster_t to_abi(const Frontier& f) {
  return {f.id,
          f.cells,
          f.centroid,
          {f.low, f.high},
          f.normal,
          f.unknown_cells,
          f.free_cells,
          {f.viewpoint, f.viewpoint_heading_rad},
          f.path_length_m,
          {0, 0}};
}

/// A clear path through the map.
struct Path {
  std::vector<Vec3> points;  // first the start, last where it ends; none if no path is known
  double length_m = std::numeric_limits<double>::infinity();
  double clearance_m = 0;  // least distance to the centre of a cell that is not free, at most 15 cells
  double time_s = std::numeric_limits<double>::infinity();  // from rest to rest, at the mission's speed

  bool known() const { return !points.empty(); }
};

/// A place where passages meet, or where one ends. World frame, metres.
struct PassageEnd {
  Vec3 position;            // in the middle of the free space
  double from_start_m = 0;  // along the passages
  double width_m = 0, height_m = 0;
  double volume_m3 = 0;               // of the junction; of another end, of the last metres before it
  double frontier_m2 = 0;             // in the same space
  karst_passage_end_kind_t kind = 0;  // KARST_PASSAGE_*
  std::uint32_t ways = 0;             // ends of passages here

  bool is_junction() const { return kind == KARST_PASSAGE_JUNCTION; }
  bool is_open() const { return kind == KARST_PASSAGE_OPEN_END; }
};

struct Passage {
  std::size_t from = 0, to = 0;  // indices of its ends, that nearer to the start first; equal for a loop
  double length_m = 0;           // between the positions of its ends
  double mean_width_m = 0, least_width_m = 0, mean_height_m = 0, least_height_m = 0;
  double volume_m3 = 0, frontier_m2 = 0;  // without the junctions
  Vec3 middle;                            // on its middle line, about half way
};

/// The graph of the passages; both lists by distance from the start. Indices hold for one map only.
struct Passages {
  std::vector<Passage> passages;
  std::vector<PassageEnd> ends;
};

/// What is around a point.
struct PassagePlace {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t passage = none, junction = none;  // indices; both `none`: it is not in a passage
  double from_start_m = 0, width_m = 0, height_m = 0;
};

inline Passage from_abi(const karst_passage_t& p) {
  return {p.ends[0],       p.ends[1],        p.length_m,  p.mean_width_m, p.least_width_m,
          p.mean_height_m, p.least_height_m, p.volume_m3, p.frontier_m2,  p.middle};
}
inline PassageEnd from_abi(const karst_passage_end_t& e) {
  return {e.position, e.from_start_m, e.width_m, e.height_m, e.volume_m3, e.frontier_m2, e.kind, e.ways};
}
inline PassagePlace from_abi(const karst_passage_place_t& p) {
  const auto index = [](std::uint32_t i) { return i == KARST_NO_PASSAGE ? PassagePlace::none : i; };
  return {index(p.passage), index(p.end), p.from_start_m, p.width_m, p.height_m};
}

struct Goal {
  Vec3 position;
  double heading_rad = std::numeric_limits<double>::quiet_NaN();  // NaN: any
  double tolerance_m = 0.5;
  double max_speed_mps = 0;       // 0: the mission's limit; not less than motion.min_speed
  std::uint32_t frontier_id = 0;  // 0: none
  double score = 0;               // higher is better, in the policy's own unit
  std::string why;                // one line for the report
};

/// A goal at the viewpoint, and with the heading, that the core proposes for a frontier.
inline Goal goal_at(const Frontier& f, double score, std::string why) {
  Goal g;
  g.position = f.viewpoint;
  g.heading_rad = f.viewpoint_heading_rad;
  g.frontier_id = f.id;
  g.score = score;
  g.why = std::move(why);
  return g;
}

/// The answer of decide(). Make one with `fly`, `tour`, `hold`, `explored` or `go_home`.
struct Decision {
  karst_outcome_t outcome = KARST_OUTCOME_HOLD;
  bool in_order = false;  // a tour
  std::vector<Goal> goals;
  std::string reason;

  /// Ranked choices, best first: the core flies to the first that passes its checks.
  static Decision fly(std::vector<Goal> goals) { return {KARST_OUTCOME_GOALS, false, std::move(goals), ""}; }
  /// Goals to visit one after the other. The core may ask again before the last one is reached.
  static Decision tour(std::vector<Goal> goals) { return {KARST_OUTCOME_GOALS, true, std::move(goals), ""}; }
  static Decision hold(std::string reason) { return {KARST_OUTCOME_HOLD, false, {}, std::move(reason)}; }
  /// Nothing is left to fly to now. The core asks again, and believes it once the vehicle has hovered without
  /// a goal for the time mission.explored_patience.
  static Decision explored(std::string reason) {
    return {KARST_OUTCOME_EXPLORED, false, {}, std::move(reason)};
  }
  static Decision go_home(std::string reason) {
    return {KARST_OUTCOME_GO_HOME, false, {}, std::move(reason)};
  }
};

/// An event between two requests. `kind` is one of KARST_EVENT_*; later minor versions add kinds.
struct Event {
  karst_event_kind_t kind = 0;
  std::int64_t stamp_ns = 0;
  Goal goal;
  std::string reason;
};

inline std::string from_abi(const karst_text_t& t) {
  return t.length == 0 ? std::string() : std::string(t.data, t.length);
}
/// A view: the string must outlive it.
inline karst_text_t to_abi(const std::string& s) { return {s.data(), s.size()}; }

inline karst_goal_t to_abi(const Goal& g) {
  return {g.position, g.heading_rad, g.tolerance_m, g.max_speed_mps, g.frontier_id,
          0,          g.score,       to_abi(g.why)};
}
inline Goal from_abi(const karst_goal_t& g) {
  return {g.position, g.heading_rad, g.tolerance_m, g.max_speed_mps, g.frontier_id, g.score, from_abi(g.why)};
}

/// Throws Error if `code`, which a service returned, is a failure.
inline void check(std::int32_t code, const karst_error_t& error) {
  if (code != KARST_OK) throw Error(error.text, code);
}

}  // namespace karst
