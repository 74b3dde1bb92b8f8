/*
 * A policy in plain C, on the ABI itself: flies to the lowest viewpoint that can be reached. It shows every
 * table there is to fill; policies in C++ get all of this from karst/policy.h.
 */
#include <karst_abi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define TEXT(literal) \
  { literal, sizeof literal - 1 }

/* One object of the policy: its parameter, and whatever it has to remember. */
typedef struct object {
  double max_path_m;
} object_t;

static void* create(const karst_host_t* host, karst_error_t* error) {
  object_t* self = malloc(sizeof *self);
  (void)host;
  if (!self) {
    error->code = KARST_ERROR_FAILED;
    snprintf(error->text, sizeof error->text, "out of memory");
  }
  return self;
}

static int32_t init(void* self, const karst_parameter_value_t* values, uint64_t count, karst_error_t* error) {
  (void)error;
  if (count == 1) ((object_t*)self)->max_path_m = values[0].number; /* in the order of declaration */
  return KARST_OK;
}

static int32_t activate(void* self, karst_error_t* error) {
  (void)self, (void)error;
  return KARST_OK;
}

static int32_t decide(void* self, const karst_request_t* request, const karst_decision_sink_t* sink,
                      karst_error_t* error) {
  const double max_path_m = ((const object_t*)self)->max_path_m;
  const karst_frontier_cluster_t* best = NULL;
  for (uint64_t i = 0; i < request->frontier_count; ++i) {
    const karst_frontier_cluster_t* f = &request->frontiers[i];
    if (!isfinite(f->viewpoint.position.z) || !(f->path_length_m <= max_path_m)) continue;
    if (!best || f->viewpoint.position.z < best->viewpoint.position.z) best = f;
  }
  if (!best) {
    const karst_text_t reason = TEXT("no frontier can be reached");
    return sink->set_outcome(sink, KARST_OUTCOME_EXPLORED, 0, reason, error);
  }
  char why[100];
  const int length = snprintf(why, sizeof why, "the lowest, %.1f m below the start",
                              request->T_world_start.position.z - best->viewpoint.position.z);
  karst_goal_t goal = {0};
  goal.position = best->viewpoint.position;
  goal.heading_rad = best->viewpoint.heading_rad;
  goal.tolerance_m = 0.5;
  goal.frontier_id = best->id;
  goal.score = -best->viewpoint.position.z;
  goal.why.data = why;
  goal.why.length = (uint64_t)length;
  const int32_t code = sink->add_goals(sink, &goal, 1, error);
  const karst_text_t none = {NULL, 0};
  return code ? code : sink->set_outcome(sink, KARST_OUTCOME_GOALS, 0, none, error);
}

static int32_t on_event(void* self, const karst_event_t* event, karst_error_t* error) {
  (void)self, (void)event, (void)error;
  return KARST_OK;
}

static void deactivate(void* self) { (void)self; }
static void destroy(void* self) { free(self); }

static const karst_parameter_t parameters[] = {{
    .id = TEXT("max_path"),
    .unit = TEXT("m"),
    .help = TEXT("frontiers with a longer way to them are ignored"),
    .default_number = 200.0,
    .low = 1.0,
    .high = 100000.0,
    .type = KARST_PARAMETER_REAL,
}};

static const karst_policy_descriptor_t descriptor = {
    .size = sizeof(karst_policy_descriptor_t),
    .id = TEXT("deepest"),
    .name = TEXT("Deepest"),
    .version = TEXT("1.0.0"),
    .min_host = {0, 1, 0},
    .parameter_count = 1,
    .parameters = parameters,
    .one_line = TEXT("Flies to the lowest frontier."),
};

static const karst_policy_t table = {
    .size = sizeof(karst_policy_t),
    .descriptor = &descriptor,
    .create = create,
    .init = init,
    .activate = activate,
    .decide = decide,
    .on_event = on_event,
    .deactivate = deactivate,
    .destroy = destroy,
};

static const karst_policy_t* policy(uint32_t index) { return index == 0 ? &table : NULL; }

static const karst_plugin_t plugin = {
    .size = sizeof(karst_plugin_t),
    .abi_major = KARST_ABI_MAJOR,
    .abi_minor = KARST_ABI_MINOR,
    .policy_count = 1,
    .policy = policy,
};

const karst_plugin_t* karst_plugin_entry(void) { return &plugin; }
