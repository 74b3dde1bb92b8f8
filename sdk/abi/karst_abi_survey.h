/*
 * karst policy ABI: the extension "karst.survey/1", the passages that a survey tells of before the flight.
 *
 * Ask the host for it: `host->extension(host, "karst.survey/1")` is a karst_survey_service_t, or NULL if the
 * host does not know it. A mission without a survey answers KARST_ERROR_UNAVAILABLE.
 *
 * A survey is what cavers have of a cave: stations, the legs between them, and the distances from the
 * stations to the walls. It may be old, wrong or incomplete: the map counts, and the survey is a hint. It
 * does not change during a mission. Positions: world frame, metres.
 */
#ifndef KARST_ABI_SURVEY_H
#define KARST_ABI_SURVEY_H
#include "karst_abi_services.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KARST_SURVEY_ID "karst.survey/1"

/* Where the survey has no distance to a wall, it counts as so many metres. */
#define KARST_SURVEY_DEFAULT_WALL_M 1.5

/* [frozen] Distances from a station to the walls: left and right of the leg, seen from its first station to
   its second; up and down vertical. All are given: see KARST_SURVEY_DEFAULT_WALL_M. */
typedef struct karst_survey_size {
  double left_m, right_m, up_m, down_m;
} karst_survey_size_t;

/* [frozen] Two stations, and the passage between them. */
typedef struct karst_survey_leg {
  uint64_t from_station, to_station; /* numbers from 0, not the same: legs that meet share one */
  karst_vec3_t from, to;
  karst_survey_size_t from_size, to_size;
  uint64_t reserved[2];
} karst_survey_leg_t;

typedef uint32_t karst_survey_lead_kind_t;
enum {
  KARST_LEAD_END = 1, /* a single leg ends here, and it is no entrance: a dead end, or not looked at */
  KARST_LEAD_CONTINUATION = 2 /* the surveyor noted that the cave goes on */
};

/* [frozen] A station where the survey ends. */
typedef struct karst_survey_lead {
  karst_vec3_t position;
  uint64_t station;
  karst_survey_lead_kind_t kind; /* KARST_LEAD_* */
  uint32_t reserved_32;
  uint64_t reserved[2];
} karst_survey_lead_t;

/* [appendable] */
typedef struct karst_survey_service {
  uint32_t size;
  uint32_t reserved;
  /* [decision thread] {deciding} The legs. Writes at most `capacity` of them; `*total` is their number. */
  int32_t (*legs)(const karst_host_t*, karst_survey_leg_t* out, uint64_t capacity, uint64_t* total,
                  karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} The leads, by station. Writes at most `capacity` of them; `*total` is their
     number. */
  int32_t (*leads)(const karst_host_t*, karst_survey_lead_t* out, uint64_t capacity, uint64_t* total,
                   karst_error_t*) KARST_NOEXCEPT;
  /* [decision thread] {deciding} Metres from each point to the nearest surveyed passage, negative in it;
     +infinity if there is no leg. A passage is a rectangle around its leg, which goes from the size at the
     leg's first station to that at its second. points and out hold `count`, at most KARST_MAX_BATCH. */
  int32_t (*distances)(const karst_host_t*, const karst_vec3_t* points, uint64_t count, double* out,
                       karst_error_t*) KARST_NOEXCEPT;
} karst_survey_service_t;

#ifdef __cplusplus
}
#endif
#endif
