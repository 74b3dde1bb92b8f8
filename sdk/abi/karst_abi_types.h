/*
 * karst policy ABI 1.0: the values that cross between host and plugin.
 *
 * Everything is C11: fixed-width integers, doubles, text as pointer and length. World frame: x east,
 * y north, z up; body frame: x forward, y left, z up. Metres, seconds, radians; time is integer
 * nanoseconds since the mission's start. Angles of heading run counter-clockwise from east.
 *
 * Every struct is marked
 *   [frozen]      its layout never changes within a major version, so it may be used in arrays. `reserved`
 *                 fields are written as zero and not read;
 *   [appendable]  it begins with `uint32_t size`: the sizeof with which the side that fills it was compiled.
 *                 It grows only at its end. Test fields added by a later minor version with KARST_HAS.
 */
#ifndef KARST_ABI_TYPES_H
#define KARST_ABI_TYPES_H
#include <stddef.h>
#include <stdint.h>

/* Function-pointer types are noexcept where the language allows: no exception crosses in either direction. */
#if defined(__cplusplus) && __cplusplus >= 201703L
#define KARST_NOEXCEPT noexcept
#else
#define KARST_NOEXCEPT
#endif

/* True if `table` (of struct type `type`) is large enough to hold `slot` and the slot is not NULL. */
#define KARST_HAS(type, table, slot) \
  ((table)->size >= offsetof(type, slot) + sizeof((table)->slot) && (table)->slot)

#ifdef __cplusplus
extern "C" {
#endif

/* [frozen] UTF-8, not terminated by zero. `data` may be NULL if `length` is 0. */
typedef struct karst_text {
  const char* data;
  uint64_t length; /* bytes */
} karst_text_t;

/* Result of every call that can fail. Zero is success; the karst_error_t says what failed. */
enum {
  KARST_OK = 0,
  KARST_ERROR_FAILED = 1,      /* failed for the reason given in the text */
  KARST_ERROR_ARGUMENT = 2,    /* an argument breaks the rules of the call */
  KARST_ERROR_LIMIT = 3,       /* more items than the host accepts in one call */
  KARST_ERROR_STATE = 4,       /* not allowed in this state of the lifecycle */
  KARST_ERROR_THREAD = 5,      /* called on a thread that the slot does not allow */
  KARST_ERROR_ABANDONED = 6,   /* the host has abandoned this policy: return at once */
  KARST_ERROR_UNAVAILABLE = 7, /* not available in this mission */
  KARST_ERROR_EXCEPTION = 8    /* the C++ wrapper caught an exception; its what() is the text */
};

#define KARST_ERROR_TEXT_SIZE 256

/* [frozen] The caller provides it, zeroed; the callee fills it when it returns a code other than KARST_OK. */
typedef struct karst_error {
  int32_t code;
  char text[KARST_ERROR_TEXT_SIZE]; /* UTF-8, terminated by zero, one line */
} karst_error_t;

/* [frozen] */
typedef struct karst_vec3 {
  double x, y, z;
} karst_vec3_t;

/* [frozen] Unit quaternion, Hamilton convention; in T_a_b it rotates vectors from frame b into frame a. */
typedef struct karst_quaternion {
  double w, x, y, z;
} karst_quaternion_t;

/* [frozen] T_a_b: a point p in frame b is position + orientation * p in frame a. */
typedef struct karst_pose {
  karst_vec3_t position;
  karst_quaternion_t orientation;
} karst_pose_t;

/* [frozen] Closed axis-aligned box, low <= high in each axis. World frame, m. */
typedef struct karst_box {
  karst_vec3_t low, high;
} karst_box_t;

/* [frozen] World frame, m. */
typedef struct karst_segment {
  karst_vec3_t from, to;
} karst_segment_t;

/* [frozen] The vehicle's state as estimated or predicted at `stamp_ns`. */
typedef struct karst_state {
  int64_t stamp_ns;
  karst_vec3_t position;          /* world, m */
  karst_vec3_t velocity;          /* world, m/s */
  karst_quaternion_t orientation; /* body to world */
  karst_vec3_t body_rate;         /* body, rad/s */
} karst_state_t;

/* [frozen] A position (world, m) and the heading of the vehicle's body there. */
typedef struct karst_viewpoint {
  karst_vec3_t position;
  double heading_rad;
} karst_viewpoint_t;

/* [frozen] A group of neighbouring frontier cells: free cells with an unknown face neighbour. */
typedef struct karst_frontier_cluster {
  uint32_t id;    /* from 1; never reused; kept while the cluster shares cells with its last version */
  uint32_t cells; /* frontier cells in it */
  karst_vec3_t centroid;
  karst_box_t bounds;
  karst_vec3_t normal;         /* unit mean direction from free into unknown; zero if it has none */
  uint32_t unknown_cells;      /* in a box of a few metres around the centroid */
  uint32_t free_cells;         /* in the same box */
  karst_viewpoint_t viewpoint; /* proposed by the core: clear, sees the cluster; NaN if none was found */
  double path_length_m; /* from the start of a new path to the viewpoint; +infinity if no path is known */
  uint64_t reserved[2];
} karst_frontier_cluster_t;

/* [frozen] Another vehicle of the team: its state as last received. World frame, m and m/s. */
typedef struct karst_teammate {
  uint32_t id;
  uint32_t reserved;
  int64_t stamp_ns; /* time of this state; negative before this vehicle's own start */
  karst_vec3_t position;
  karst_vec3_t velocity;
  karst_vec3_t goal;            /* NaN if none is known */
  double seconds_before_homing; /* estimate; 0: it no longer explores; NaN: its path home is not known */
} karst_teammate_t;

typedef uint32_t karst_sensor_kind_t;
enum {
  KARST_SENSOR_LIDAR = 1,  /* angles are azimuth and elevation: a sector of a sphere */
  KARST_SENSOR_CAMERA = 2, /* angles bound a pinhole camera's field of view: a pyramid about the x axis */
  KARST_SENSOR_RGB = 3     /* a colour camera, also a pyramid: its pictures do not change the map, and within
                              its range rock is lit and in focus */
  /* Minor versions add kinds: ignore those you do not know. */
};

/* [frozen] The field of view of a sensor, in its own frame (x forward, y left, z up). */
typedef struct karst_sensor {
  karst_text_t name;
  karst_sensor_kind_t kind;
  uint32_t reserved;
  karst_pose_t T_body_sensor;
  double min_range_m, max_range_m;
  double horizontal_fov_rad;                    /* full angle, centred on x; 2 pi: all around */
  double low_elevation_rad, high_elevation_rad; /* -pi/2 .. pi/2 */
} karst_sensor_t;

/* [frozen] A goal that the policy proposes. */
typedef struct karst_goal {
  karst_vec3_t position; /* world, finite */
  double heading_rad;    /* NaN: any */
  double tolerance_m;    /* > 0; the goal is reached when the vehicle is nearer than this */
  double max_speed_mps;  /* 0: the mission's limit, which also caps it; not below the mission's min_speed */
  uint32_t frontier_id;  /* 0: none */
  uint32_t reserved;
  double score;     /* in the policy's own unit, higher is better; finite */
  karst_text_t why; /* one line for the report, at most 240 bytes */
} karst_goal_t;

typedef uint32_t karst_outcome_t;
enum {
  KARST_OUTCOME_GOALS = 1,    /* the goals in the sink */
  KARST_OUTCOME_HOLD = 2,     /* continue to the current goal, or stay; the core asks again soon */
  KARST_OUTCOME_EXPLORED = 3, /* nothing is left to explore: it flies home if the next answers agree */
  KARST_OUTCOME_GO_HOME = 4   /* fly home for another reason */
};

/* The fate of the last chosen goal. */
typedef uint32_t karst_goal_fate_t;
enum {
  KARST_FATE_NONE = 0, /* no goal has been chosen yet */
  KARST_FATE_UNDER_WAY = 1,
  KARST_FATE_REACHED = 2,
  KARST_FATE_REJECTED = 3,    /* failed the core's checks */
  KARST_FATE_UNREACHABLE = 4, /* no path to it was found or remains */
  KARST_FATE_ABANDONED = 5,   /* the core abandoned it in flight */
  KARST_FATE_SUPERSEDED = 6   /* a later decision replaced it */
};

#ifdef __cplusplus
}
#endif
#endif
