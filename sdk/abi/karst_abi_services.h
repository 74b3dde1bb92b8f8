/*
 * karst policy ABI 1.0: the services that the host offers to a policy.
 *
 * Services work on batches: a thousand points cost little more than one. Positions: world frame, metres.
 * Results go into arrays that the caller owns. A call that fails leaves its outputs unspecified.
 *
 * Tags of each slot:
 *   [decision thread]  only on the thread on which the host calls the policy
 *   [any thread]       also on the policy's own threads
 *   {deciding}         only while decide() runs;   {any state} from create() to destroy()
 */
#ifndef KARST_ABI_SERVICES_H
#define KARST_ABI_SERVICES_H
#include "karst_abi_types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct karst_host karst_host_t;
typedef struct karst_map karst_map_t; /* opaque: a snapshot of the occupancy map */

/* Limits of one call. More items than these are KARST_ERROR_LIMIT. */
#define KARST_MAX_BATCH 1000000u
#define KARST_MAX_GAIN_VIEWPOINTS 4096u
#define KARST_MAX_PATH_GOALS 4096u
#define KARST_MAX_PATHS 64u           /* goals of one call of paths */
#define KARST_MAX_PATH_POINTS 500000u /* of all paths of one call */
#define KARST_MAX_RAY_LENGTH_M 1000.0
#define KARST_MAX_ROCK_DISTANCE_M 100.0
#define KARST_MAX_GAIN_RANGE_M 60.0
#define KARST_MAX_GAIN_RANGE_CELLS 300u /* max_range_m in cells of the map: 60 m at 0.2 m */
#define KARST_MAX_GAIN_RAYS 2000000u    /* of one sensor; neighbours are at most a cell apart at its range */
#define KARST_MAX_SENSOR_OFFSET_M 10.0  /* from the body's origin */

typedef uint8_t karst_cell_t;
enum { KARST_CELL_UNKNOWN = 0, KARST_CELL_FREE = 1, KARST_CELL_OCCUPIED = 2 };

/* [frozen] The cell with integer index k covers [k, k + 1) * resolution_m of each world axis. */
typedef struct karst_map_info {
  double resolution_m;
  uint64_t revision; /* grows when the class of any cell changes */
  uint64_t free_cells, occupied_cells;
} karst_map_info_t;

/* [frozen] Where a ray ended. */
typedef struct karst_ray_end {
  karst_vec3_t center; /* centre of the cell that stopped it, or of the last cell it passed */
  double length_m;     /* from the ray's start to that centre */
  karst_cell_t state;  /* FREE: nothing stopped it. UNKNOWN, OCCUPIED: the class of the cell that did */
  uint8_t reserved[7];
} karst_ray_end_t;

/* Bits of cast_rays' flags. */
enum { KARST_RAY_THROUGH_UNKNOWN = 1u }; /* unknown cells do not stop the ray */

/* [frozen] Number of cells of each class whose centres lie in a box. */
typedef struct karst_cell_counts {
  uint64_t unknown, free, occupied;
} karst_cell_counts_t;

/* What is at the end of a passage. */
typedef uint32_t karst_passage_end_kind_t;
enum {
  KARST_PASSAGE_JUNCTION = 1, /* other passages: three or more ends meet */
  KARST_PASSAGE_DEAD_END = 2, /* rock */
  KARST_PASSAGE_OPEN_END = 3, /* unknown space, on a quarter of its cross-section or more */
  KARST_PASSAGE_RING = 4      /* its own beginning: a passage without a junction comes back */
  /* Minor versions add kinds: ignore those you do not know. */
};

/*
 * Widths and heights are those of free cells: the shortest of ten horizontal lines through a place, and the
 * vertical line through it; at most 100 m. They grow while the walls are not known yet.
 */

/* [frozen] A place where passages meet, or where one ends. */
typedef struct karst_passage_end {
  karst_vec3_t position;    /* in the middle of the free space */
  double from_start_m;      /* along the passages */
  double width_m, height_m; /* at the position */
  double volume_m3;   /* of the free cells of the junction; of another end, of the last metres before it */
  double frontier_m2; /* in the same space: free cells with an unknown face neighbour, times a cell's face */
  karst_passage_end_kind_t kind;
  uint32_t ways; /* ends of passages here */
  uint64_t reserved[2];
} karst_passage_end_t;

/* [frozen] A passage from one end to the other. */
typedef struct karst_passage {
  uint32_t ends[2]; /* indices of its ends, that nearer to the start first; equal for a loop */
  double length_m;  /* between the positions of its ends, along its middle */
  double mean_width_m, least_width_m, mean_height_m, least_height_m;
  double volume_m3;    /* of its free cells, without the junctions */
  double frontier_m2;  /* in the same space, as that of an end */
  karst_vec3_t middle; /* a place on its middle line, about half way */
  uint64_t reserved[2];
} karst_passage_t;

#define KARST_NO_PASSAGE 0xffffffffu

/* [frozen] What is around a point: the index of its passage or that of its junction. The other is
   KARST_NO_PASSAGE. So are both, and the rest is 0, if the point is not in the space of the passages. */
typedef struct karst_passage_place {
  uint32_t passage, end;
  double from_start_m;      /* along the passages */
  double width_m, height_m; /* of the slice of passage that holds the point */
} karst_passage_place_t;

/*
 * [appendable] The occupancy map.
 *
 * The request's snapshot is a view of the core's map: it lives until decide() returns, unless the policy
 * retains it. Retaining copies the map (tens of milliseconds for a large one), so a retained snapshot
 * never changes. The caller of retain() must release the snapshot.
 */
typedef struct karst_map_service {
  uint32_t size;
  uint32_t reserved;
  /* [any thread] {any state} */
  int32_t (*info)(const karst_host_t*, const karst_map_t*, karst_map_info_t* out,
                  karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} Class of the cell that contains each point; points and out hold `count`. */
  int32_t (*cell_states)(const karst_host_t*, const karst_map_t*, const karst_vec3_t* points, uint64_t count,
                         karst_cell_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} Each ray visits every cell it passes, the cells of both its ends included. */
  int32_t (*cast_rays)(const karst_host_t*, const karst_map_t*, const karst_segment_t* rays, uint64_t count,
                       uint32_t flags, karst_ray_end_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} A box of 2^63 cells or more is KARST_ERROR_LIMIT. */
  int32_t (*count_in_boxes)(const karst_host_t*, const karst_map_t*, const karst_box_t* boxes, uint64_t count,
                            karst_cell_counts_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} Centres of the occupied cells in the box that have a free face neighbour, in
     ascending (z, y, x). Writes at most `capacity` of them; `*total` is the number found. */
  int32_t (*surface_cells)(const karst_host_t*, const karst_map_t*, karst_box_t box, karst_vec3_t* out,
                           uint64_t capacity, uint64_t* total, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} Returns a copy of the snapshot, or NULL with the error filled. */
  const karst_map_t* (*retain)(const karst_host_t*, const karst_map_t*, karst_error_t*)KARST_NOEXCEPT;
  /* [any thread] {any state} Releases a snapshot that retain() returned; call it once. */
  void (*release)(const karst_host_t*, const karst_map_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} Distance from each point to the centre of the nearest occupied cell, in metres;
     limit_m if none is nearer. Only occupied cells are rock: unknown ones are not. limit_m is in
     (0, KARST_MAX_ROCK_DISTANCE_M]. Where no rock is near, the cost grows with the cube of limit_m in cells:
     100,000,000 cells visited in one call are KARST_ERROR_LIMIT. */
  int32_t (*distances_to_rock)(const karst_host_t*, const karst_map_t*, const karst_vec3_t* points,
                               uint64_t count, double limit_m, double* out, karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} The passages that are connected to the start of the mission through free cells
     with room around them, as far as they are mapped, and their ends; both by distance from the start. None
     if there is no such cell within 5 m of the start. Writes as many as there is room for; the totals are the
     numbers found. The host finds them once for each map, at the first question: a twentieth of a second for
     a million known cells. 50,000,000 steps of work are KARST_ERROR_LIMIT: one for each known cell, 60 for
     each cube of space (0.8 m at 0.2 m), 1000 for each slice of passage (two cubes thick). Indices hold for
     this map only. Branches not longer than they are wide are left out, and passages narrower than five
     cells may be. */
  int32_t (*passages)(const karst_host_t*, const karst_map_t*, karst_passage_t* passages,
                      uint64_t passage_capacity, uint64_t* passage_total, karst_passage_end_t* ends,
                      uint64_t end_capacity, uint64_t* end_total, karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} What is around each point; points and out hold `count`. A point in rock or in
     the unknown is in the space of the passages if that is within about a metre and a half. */
  int32_t (*passages_at)(const karst_host_t*, const karst_map_t*, const karst_vec3_t* points, uint64_t count,
                         karst_passage_place_t* out, karst_error_t*) KARST_NOEXCEPT;
} karst_map_service_t;

/* [frozen] A path, without its points. Without a known path length_m and time_s are +infinity, clearance_m is
   0, and there are no points. */
typedef struct karst_path {
  double length_m;    /* of the polyline through its points */
  double clearance_m; /* least distance from it to the centre of a cell that is not free, occupied or unknown:
                         to an eighth of a cell, and at most 15 cells of the map */
  double time_s;      /* estimate of the flight from rest to rest, at the mission's speed limit */
  uint64_t points_end; /* its points are those from the end of the path before it, 0 for the first, to here */
} karst_path_t;

/* [appendable] Paths through the map of this request. */
typedef struct karst_path_service {
  uint32_t size;
  uint32_t reserved;
  /* [any thread] {deciding} Length of a clear path from `from` to within `tolerance_m` of each goal, in
     metres; +infinity if no path is known. (Too many goals far from clear cells: KARST_ERROR_LIMIT.) */
  int32_t (*lengths)(const karst_host_t*, karst_vec3_t from, const karst_vec3_t* goals, uint64_t count,
                     double tolerance_m, double* out, karst_error_t*) KARST_NOEXCEPT;
  /* [any thread] {deciding} A clear path from `from` to within `tolerance_m` of each goal, one in `out` for
     each goal, and the points of all of them, in the world frame: first `from`, last the place where the path
     ends. Writes at most `capacity` points; the last path's points_end is the number of all. The path flown
     is smoother, a few per cent shorter, and keeps farther from rock where there is room. One search for each
     goal: lengths() costs far less. At most KARST_MAX_PATHS goals; more points than KARST_MAX_PATH_POINTS, or
     more goals than can be searched in a map so large, are KARST_ERROR_LIMIT. */
  int32_t (*paths)(const karst_host_t*, karst_vec3_t from, const karst_vec3_t* goals, uint64_t count,
                   double tolerance_m, karst_path_t* out, karst_vec3_t* points, uint64_t capacity,
                   karst_error_t*) KARST_NOEXCEPT;
} karst_path_service_t;

/* [appendable] Information gain of viewpoints. */
typedef struct karst_gain_service {
  uint32_t size;
  uint32_t reserved;
  /* [any thread] {any state} Number of unknown cells that each sensor would see from each viewpoint: rays
     end at occupied cells and at max_range_m, and pass unknown ones. out[v * sensor_count + s] is for
     viewpoint v, sensor s; a cell is counted once for each pair. The cost grows with the cube of max_range_m:
     pass a sensor with a shorter range to count near cells only. Neighbouring rays are at most one cell apart
     where they end. A range of more cells, or a view of more rays, than the limits is KARST_ERROR_LIMIT. */
  int32_t (*newly_seen)(const karst_host_t*, const karst_map_t*, const karst_sensor_t* sensors,
                        uint64_t sensor_count, const karst_viewpoint_t* viewpoints, uint64_t count,
                        uint64_t* out, karst_error_t*) KARST_NOEXCEPT;
} karst_gain_service_t;

/* [appendable] Drawings appear in the report, next to the decision that made them. Colours are 0xRRGGBB. */
typedef struct karst_draw_service {
  uint32_t size;
  uint32_t reserved;
  /* [decision thread] {deciding} */
  int32_t (*points)(const karst_host_t*, const karst_vec3_t* points, uint64_t count, uint32_t rgb,
                    karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} */
  int32_t (*lines)(const karst_host_t*, const karst_segment_t* lines, uint64_t count, uint32_t rgb,
                   karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} At most 240 bytes. */
  int32_t (*text)(const karst_host_t*, karst_vec3_t at, karst_text_t text, uint32_t rgb,
                  karst_error_t*) KARST_NOEXCEPT;
} karst_draw_service_t;

enum { KARST_LOG_DEBUG = 0, KARST_LOG_INFO = 1, KARST_LOG_WARNING = 2 };

/*
 * [appendable] Given to create(); lives until destroy() has returned. Every call takes it back as its first
 * argument. A service that this host does not offer is NULL or beyond `size`: test with KARST_HAS.
 */
struct karst_host {
  uint32_t size;
  uint32_t abi_minor; /* of the host; its major equals the plugin's, or the plugin would not be loaded */
  void* context;      /* for the host's use only */
  const karst_map_service_t* map;
  const karst_path_service_t* path;
  const karst_gain_service_t* gain;
  const karst_draw_service_t* draw;
  /* [any thread] {any state} One line; text beyond 1000 bytes is cut. */
  void (*log)(const karst_host_t*, uint32_t level, karst_text_t text) KARST_NOEXCEPT;
  /* [decision thread] {any state} The only random source a policy may use: independent numbers, uniform in
     [0, 1), the same in every replay with the mission's seed. */
  void (*random)(const karst_host_t*, double* out, uint64_t count) KARST_NOEXCEPT;
  /* [any thread] {any state} The only clock a policy may use: mission time of the request (between requests,
     of the latest request or event). It stands still while decide() runs. */
  int64_t (*now_ns)(const karst_host_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} Nonzero once the host no longer waits: return at once. Long loops should call it
   * regularly. */
  uint32_t (*should_stop)(const karst_host_t*) KARST_NOEXCEPT;
  /* [any thread] {any state} An optional feature such as "karst.example/1", or NULL. */
  const void* (*extension)(const karst_host_t*, karst_text_t id)KARST_NOEXCEPT;
};

#ifdef __cplusplus
}
#endif
#endif
