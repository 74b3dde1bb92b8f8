/*
 * karst policy ABI: the extension "karst.imaged/1", what the vehicle's colour camera has seen of the surface.
 *
 * Ask the host for it: `host->extension(host, "karst.imaged/1")` is a karst_imaged_service_t, or NULL of a
 * host that does not know it. A mission without a colour camera answers KARST_ERROR_UNAVAILABLE.
 *
 * A surface cell is an occupied cell of the map with a free face neighbour. It counts as imaged once it, or a
 * cell that shares a face with it, was in a picture: a face of it in the camera's range and field of view,
 * nothing but free cells on the way there, and the surface not more at a slant than the camera's greatest
 * incidence. The core keeps the account along its estimated trajectory, for all pictures taken so far.
 *
 * All answers are about the map of the request and the account at that moment.
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
  KARST_IMAGED_NOT = 1,        /* surface no picture shows yet */
  KARST_IMAGED_YES = 2
};

/* [frozen] The colour camera. */
typedef struct karst_imaged_camera {
  karst_sensor_t sensor;    /* kind KARST_SENSOR_RGB; its range is that in which surface counts as seen */
  double max_incidence_rad; /* greatest angle between the surface's normal and the way to the camera */
  double period_s;          /* between two pictures */
  uint64_t reserved[2];
} karst_imaged_camera_t;

/* [frozen] A surface cell. */
typedef struct karst_surface_cell {
  karst_vec3_t center;
  karst_vec3_t normal; /* unit, into free space; zero where the rock is free on all sides */
} karst_surface_cell_t;

/* [appendable] */
typedef struct karst_imaged_service {
  uint32_t size;
  uint32_t reserved;
  /* [decision thread] {deciding} */
  int32_t (*camera)(const karst_host_t*, karst_imaged_camera_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} State of the cell that holds each point. */
  int32_t (*states)(const karst_host_t*, const karst_vec3_t* points, uint64_t count, karst_imaged_t* out,
                    karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} Surface cells not imaged yet whose centres lie in the box, in ascending
     (z, y, x). Writes at most `capacity` of them; `*total` is how many there are. */
  int32_t (*unimaged)(const karst_host_t*, karst_box_t box, karst_surface_cell_t* out, uint64_t capacity,
                      uint64_t* total, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} How many of the cells not imaged yet a picture from each viewpoint would
     show; the vehicle level. At most KARST_MAX_GAIN_VIEWPOINTS. */
  int32_t (*newly_imaged)(const karst_host_t*, const karst_viewpoint_t* viewpoints, uint64_t count,
                          uint64_t* out, karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} Which those are: their centres, for each viewpoint in ascending (z, y, x),
     one viewpoint after the other; `ends[i]` is how many there are up to viewpoint i's last. Writes at most
     `capacity` of them. */
  int32_t (*newly_imaged_cells)(const karst_host_t*, const karst_viewpoint_t* viewpoints, uint64_t count,
                                uint64_t* ends, karst_vec3_t* out, uint64_t capacity,
                                karst_error_t*) KARST_NOEXCEPT;
} karst_imaged_service_t;

#ifdef __cplusplus
}
#endif
#endif
