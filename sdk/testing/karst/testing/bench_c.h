/*
 * The test bench for policies in C: calls a policy through its tables, as the host does, in a map drawn by
 * hand.
 *
 *   karst_bench_t* bench = karst_bench_create(karst_plugin_entry(), drawing, 1.0, "max_path=50", &error);
 *   karst_bench_offer(bench, 1, karst_bench_place(bench, 'a'), karst_bench_place(bench, 'a'), 20);
 *   karst_bench_decide(bench, &error);
 *   karst_bench_goal(bench, 0).frontier_id ...
 *   karst_bench_destroy(bench);
 *
 * The test is linked with the policy's own source, which defines karst_plugin_entry, and in CMake with
 * karst::testing_c. This is the interface of karst/testing/bench.h in C; what is missing here is there.
 *
 * Units and frames are those of the ABI. A call that can fail returns KARST_OK or an error's code, and fills
 * the error, which may be NULL.
 */
#ifndef KARST_TESTING_BENCH_C_H
#define KARST_TESTING_BENCH_C_H
#include <karst_abi.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct karst_bench karst_bench_t;

/* What the next request says of the vehicle. */
typedef struct karst_bench_state {
  karst_vec3_t position; /* world, m */
  karst_vec3_t start;    /* world, m: the position of T_world_start */
  karst_vec3_t direction_of_flight;
  double heading_rad;
  double time_s, seconds_before_homing;
  double battery_fraction, battery_seconds_left, mission_seconds_left;
} karst_bench_state_t;

/*
 * A bench with policy 0 of the plugin, created, initialized and activated. NULL if that fails.
 *
 * `drawing`: layers seen from above, the lowest first, with an empty line between two; the first row of a
 * layer is the northernmost. '#' is occupied, '?' unknown, '.' free; a letter is a free cell with a name. The
 * lower south-western corner is the world's origin. `resolution_m`: the edge of a cell. `parameters`:
 * "id=value id=value", in SI units without the unit; the others have their defaults. May be NULL.
 */
karst_bench_t* karst_bench_create(const karst_plugin_t* plugin, const char* drawing, double resolution_m,
                                  const char* parameters, karst_error_t* error) KARST_NOEXCEPT;
/* NULL is allowed. */
void karst_bench_destroy(karst_bench_t* bench) KARST_NOEXCEPT;

/* Centre of the cell of that name; NaN if there is none. */
karst_vec3_t karst_bench_place(const karst_bench_t* bench, char letter) KARST_NOEXCEPT;

karst_bench_state_t karst_bench_get_state(const karst_bench_t* bench) KARST_NOEXCEPT;
void karst_bench_set_state(karst_bench_t* bench, const karst_bench_state_t* state) KARST_NOEXCEPT;

/* The vehicle's sensors; at first it has the LiDAR of the simulated vehicles. The names must outlive the
   bench. */
void karst_bench_set_sensors(karst_bench_t* bench, const karst_sensor_t* sensors,
                             uint64_t count) KARST_NOEXCEPT;

/* Adds a frontier. The path to it is measured in the map, from where the vehicle is now. */
void karst_bench_offer(karst_bench_t* bench, uint32_t id, karst_vec3_t viewpoint, karst_vec3_t centroid,
                       uint32_t cells) KARST_NOEXCEPT;
/* Replaces the frontiers by those of the drawing: free cells that border on unknown ones; ids from 1. */
void karst_bench_offer_drawn(karst_bench_t* bench, uint32_t min_cells) KARST_NOEXCEPT;
void karst_bench_clear_frontiers(karst_bench_t* bench) KARST_NOEXCEPT;

/* Requests one decision. The functions below tell the last answer; their texts live until the next request.
 */
int32_t karst_bench_decide(karst_bench_t* bench, karst_error_t* error) KARST_NOEXCEPT;
karst_outcome_t karst_bench_outcome(const karst_bench_t* bench) KARST_NOEXCEPT; /* 0 if there is no answer */
int karst_bench_is_tour(const karst_bench_t* bench) KARST_NOEXCEPT;
const char* karst_bench_reason(const karst_bench_t* bench) KARST_NOEXCEPT;
uint64_t karst_bench_goal_count(const karst_bench_t* bench) KARST_NOEXCEPT;
/* All zero, and "", if there are not so many goals. */
karst_goal_t karst_bench_goal(const karst_bench_t* bench, uint64_t index) KARST_NOEXCEPT;
const char* karst_bench_why(const karst_bench_t* bench, uint64_t index) KARST_NOEXCEPT;

/* Lines that the policy has logged, and its drawings; "" if there are not so many. */
uint64_t karst_bench_log_count(const karst_bench_t* bench) KARST_NOEXCEPT;
const char* karst_bench_log(const karst_bench_t* bench, uint64_t index) KARST_NOEXCEPT;
uint64_t karst_bench_drawing_count(const karst_bench_t* bench) KARST_NOEXCEPT;

/* The first goal of the last answer is reached: moves the vehicle there, notifies the policy and measures all
   paths from there. */
int32_t karst_bench_arrive(karst_bench_t* bench, karst_error_t* error) KARST_NOEXCEPT;
/* That goal failed. `kind`: KARST_EVENT_GOAL_REJECTED, _UNREACHABLE, _ABANDONED or _SUPERSEDED. */
int32_t karst_bench_fail(karst_bench_t* bench, karst_event_kind_t kind, const char* reason,
                         karst_error_t* error) KARST_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
