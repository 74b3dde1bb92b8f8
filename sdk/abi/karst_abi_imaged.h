/*
 * karst policy ABI: the extension "karst.imaged/1", which surface cells the colour camera has imaged so far.
 *
 * Ask the host for it: `host->extension(host, "karst.imaged/1")` is a karst_imaged_service_t, or NULL if the
 * host does not know it. A mission without a colour camera answers KARST_ERROR_UNAVAILABLE.
 *
 * A surface cell is an occupied cell of the map with a free face neighbour. It counts as imaged once it, or a
 * cell that shares a face with it, was in a picture: one of its faces was in the camera's range and field of
 * view, only free cells lay on the ray to it, and the angle of incidence was at most max_incidence_rad.
 * The core keeps this record along its estimated trajectory, for all pictures taken so far.
 *
 * All answers refer to the request's map and to the record at that moment. Positions: world frame, metres.
 */
#ifndef KARST_ABI_IMAGED_H
#define KARST_ABI_IMAGED_H
#include "karst_abi_services.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KARST_IMAGED_ID "karst.imaged/1"

typedef uint8_t karst_imaged_t;
enum {
  KARST_IMAGED_NO_SURFACE = 0, /* free, unknown, or inside the rock */
  KARST_IMAGED_NOT = 1,        /* surface that no picture shows yet */
  KARST_IMAGED_YES = 2
};

/* [frozen] The colour camera. */
typedef struct karst_imaged_camera {
  karst_sensor_t sensor;    /* kind KARST_SENSOR_RGB; surface within its range counts as seen */
  double max_incidence_rad; /* largest angle between the surface normal and the line to the camera */
  double period_s;          /* between two pictures */
  uint64_t reserved[2];
} karst_imaged_camera_t;

/* [frozen] A surface cell. */
typedef struct karst_surface_cell {
  karst_vec3_t center;
  karst_vec3_t normal; /* unit, into free space; zero where free cells lie on all sides */
} karst_surface_cell_t;

/* [appendable] */
typedef struct karst_imaged_service {
  uint32_t size;
  uint32_t reserved;
  /* [decision thread] {deciding} */
  int32_t (*camera)(const karst_host_t*, karst_imaged_camera_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} State of the cell that contains each point; points and out hold `count`. */
  int32_t (*states)(const karst_host_t*, const karst_vec3_t* points, uint64_t count, karst_imaged_t* out,
                    karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} Surface cells not imaged yet whose centres lie in the box, in ascending
     (z, y, x). Writes at most `capacity` of them; `*total` is the number found. */
  int32_t (*unimaged)(const karst_host_t*, karst_box_t box, karst_surface_cell_t* out, uint64_t capacity,
                      uint64_t* total, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} Number of cells not imaged yet that a picture from each viewpoint would
     show, with the vehicle level. At most KARST_MAX_GAIN_VIEWPOINTS. */
  int32_t (*newly_imaged)(const karst_host_t*, const karst_viewpoint_t* viewpoints, uint64_t count,
                          uint64_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} The centres of those cells: viewpoint after viewpoint, each viewpoint's in
     ascending (z, y, x). Viewpoint i's cells are out[ends[i - 1]] to out[ends[i] - 1], from out[0] for i = 0.
     Writes at most `capacity` of them; `ends` counts all. */
  int32_t (*newly_imaged_cells)(const karst_host_t*, const karst_viewpoint_t* viewpoints, uint64_t count,
                                uint64_t* ends, karst_vec3_t* out, uint64_t capacity,
                                karst_error_t*) KARST_NOEXCEPT;
} karst_imaged_service_t;

#ifdef __cplusplus
}
#endif
#endif
