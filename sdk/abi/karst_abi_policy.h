/*
 * karst policy ABI 1.0: what a policy is, its requests, and its answers.
 *
 * Lifecycle: create -> init(parameters) -> activate -> decide ... on_event ... -> deactivate -> destroy.
 * The host makes all these calls on one thread, the decision thread. It may destroy an object in any state.
 *
 * Ownership: memory is freed by the side that allocated it. Data passed by the host lives until the call
 * returns, except a map snapshot that the policy retained. Data passed by the policy is copied before the
 * call returns. Descriptors and tables live as long as the process.
 */
#ifndef KARST_ABI_POLICY_H
#define KARST_ABI_POLICY_H
#include "karst_abi_services.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef uint32_t karst_parameter_type_t;
enum {
  KARST_PARAMETER_REAL = 1,
  KARST_PARAMETER_INTEGER = 2, /* passed as a double: exact up to 2^53 */
  KARST_PARAMETER_BOOLEAN = 3, /* 0 or 1 */
  KARST_PARAMETER_TEXT = 4
};

/* [frozen] One parameter that a policy declares. The host reads, converts and checks values against it. */
typedef struct karst_parameter {
  karst_text_t id;      /* [a-z][a-z0-9_]*, unique in the policy */
  karst_text_t unit;    /* for REAL: "m", "m/s", "s", "rad", ...; empty for a plain number */
  karst_text_t help;    /* one line */
  karst_text_t choices; /* for TEXT: the allowed values, separated by '|'; empty if any is allowed */
  karst_text_t default_text;
  double default_number;
  double low, high; /* for REAL and INTEGER: the allowed range, ends included */
  karst_parameter_type_t type;
  uint32_t reserved;
} karst_parameter_t;

/* [frozen] The resolved value of a parameter, in SI units. */
typedef struct karst_parameter_value {
  karst_text_t id;
  karst_text_t text; /* for TEXT */
  double number;     /* for the other types */
  karst_parameter_type_t type;
  uint32_t reserved;
} karst_parameter_value_t;

/* [appendable] */
typedef struct karst_policy_descriptor {
  uint32_t size;
  uint32_t reserved;
  karst_text_t id;      /* its name in a mission file: [a-z][a-z0-9_]* */
  karst_text_t name;    /* for people */
  karst_text_t version; /* the policy's own semantic version */
  uint32_t min_host[3]; /* oldest karst release it works with: major, minor, patch */
  uint32_t parameter_count;
  const karst_parameter_t* parameters;
  karst_text_t one_line; /* what it does, in one line */
} karst_policy_descriptor_t;

/* [appendable] A request of the host. Arrays and pointers live until decide() returns. */
typedef struct karst_request {
  uint32_t size;
  uint32_t sequence;                /* 1, 2, ... */
  int64_t stamp_ns;                 /* time of this request */
  int64_t deadline_ns;              /* time at which the answer takes effect */
  karst_state_t state;              /* in flight: predicted for deadline_ns */
  karst_vec3_t direction_of_flight; /* unit, world frame; along the heading while the vehicle is at rest */
  karst_pose_t T_world_start;       /* pose of the start in the world frame */
  double seconds_before_homing;     /* time left until the return home must begin */
  double max_speed_mps, clearance_m, vehicle_radius_m;
  karst_vec3_t last_goal; /* meaningless if last_fate is NONE */
  karst_goal_fate_t last_fate;
  uint32_t sensor_count;
  const karst_sensor_t* sensors;
  const karst_map_t* map;
  const karst_frontier_cluster_t* frontiers; /* by ascending id */
  uint64_t frontier_count;
  const karst_teammate_t* teammates;
  uint64_t teammate_count;
  /* Of the last three 0 means "not told". They refer to stamp_ns. */
  double battery_fraction;     /* share of the battery's energy that is left, (0, 1] */
  double battery_seconds_left; /* flight time until the battery is empty, at the recent mean power */
  double mission_seconds_left; /* of the mission's maximum flight time; +infinity: it has none */
} karst_request_t;

/* Bits of set_outcome's flags. A tour is a preference: the core flies to the first goal that passes its
   checks and may ask again before the tour ends, because new measurements change what is worth visiting. */
enum { KARST_DECISION_TOUR = 1u }; /* the goals are visited in this order; they are not ranked alternatives */

/* [appendable] Receives the answer. [decision thread] {deciding} */
typedef struct karst_decision_sink {
  uint32_t size;
  uint32_t max_goals; /* the most goals that this host accepts in one decision */
  void* context;      /* for the host's use only */
  /* Adds goals, best first. More than max_goals in total makes the whole decision an error. */
  int32_t (*add_goals)(const struct karst_decision_sink*, const karst_goal_t* goals, uint64_t count,
                       karst_error_t*) KARST_NOEXCEPT;
  /* Must be called exactly once. `reason` is one line, at most 240 bytes; may be empty for GOALS. */
  int32_t (*set_outcome)(const struct karst_decision_sink*, karst_outcome_t outcome, uint32_t flags,
                         karst_text_t reason, karst_error_t*) KARST_NOEXCEPT;
} karst_decision_sink_t;

typedef uint32_t karst_event_kind_t;
enum {
  KARST_EVENT_GOAL_REACHED = 1,
  KARST_EVENT_GOAL_REJECTED = 2,
  KARST_EVENT_GOAL_UNREACHABLE = 3,
  KARST_EVENT_GOAL_ABANDONED = 4,
  KARST_EVENT_GOAL_SUPERSEDED = 5,
  KARST_EVENT_HOMING = 6,          /* the return home has begun: no more requests */
  KARST_EVENT_FRAME_CORRECTED = 7, /* the pose estimate jumped: remembered positions are off by that jump */
  KARST_EVENT_MAP_MERGED = 8       /* another vehicle's map was merged into the map */
  /* Minor versions add kinds: ignore those you do not know. */
};

/* [appendable] */
typedef struct karst_event {
  uint32_t size;
  karst_event_kind_t kind;
  int64_t stamp_ns;
  karst_goal_t goal;   /* for the GOAL kinds: the goal as it was proposed */
  karst_text_t reason; /* one line */
} karst_event_t;

/*
 * [appendable] A policy. All slots up to destroy are mandatory. `self` is the object that create() returned.
 * All slots are [decision thread] unless tagged. A nonzero return with a filled error is a failure.
 */
typedef struct karst_policy {
  uint32_t size;
  uint32_t reserved;
  const karst_policy_descriptor_t* descriptor;
  /* Returns a new object in the state {created}, or NULL with the error filled. */
  void* (*create)(const karst_host_t* host, karst_error_t*)KARST_NOEXCEPT;
  /* {created} Called once, with a value for every declared parameter, in the order of declaration. */
  int32_t (*init)(void* self, const karst_parameter_value_t* values, uint64_t count,
                  karst_error_t*) KARST_NOEXCEPT;
  /* {initialized} Requests follow. */
  int32_t (*activate)(void* self, karst_error_t*) KARST_NOEXCEPT;
  /* {active} Fills the sink. Three consecutive failures, or a call that exceeds the host's hang limit, end
     the policy; the fallback takes over. */
  int32_t (*decide)(void* self, const karst_request_t*, const karst_decision_sink_t*,
                    karst_error_t*) KARST_NOEXCEPT;
  /* {active} Between two requests. */
  int32_t (*on_event)(void* self, const karst_event_t*, karst_error_t*) KARST_NOEXCEPT;
  /* {active} -> initialized. */
  void (*deactivate)(void* self) KARST_NOEXCEPT;
  /* {any state} */
  void (*destroy)(void* self) KARST_NOEXCEPT;
  /* {any state} [any thread] Optional: a table for an extension such as "karst.example/1", or NULL. */
  const void* (*extension)(void* self, karst_text_t id)KARST_NOEXCEPT;
} karst_policy_t;

#ifdef __cplusplus
}
#endif
#endif
