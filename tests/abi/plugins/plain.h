/*
 * A well-behaved policy in plain C: one goal a metre ahead of the vehicle. A plugin of the drawer defines
 * the macro of the part it spoils before including this file, and nothing else.
 */
#include "karst_abi.h"

#define TEXT(s) \
  { s, sizeof s - 1 }

#ifndef POLICY_ID
#define POLICY_ID "plain"
#endif
#ifndef ABI_MAJOR
#define ABI_MAJOR KARST_ABI_MAJOR
#endif
#ifndef ABI_MINOR
#define ABI_MINOR KARST_ABI_MINOR
#endif
#ifndef MIN_HOST
#define MIN_HOST \
  { 0, 1, 0 }
#endif
#ifndef DEFAULT_STEP
#define DEFAULT_STEP 1.0
#endif
#ifndef TABLE_SIZE
#define TABLE_SIZE sizeof(karst_policy_t)
#endif

static const karst_host_t* the_host;
static double step_m = DEFAULT_STEP;

static void* create(const karst_host_t* host, karst_error_t* error) {
  (void)error;
  the_host = host;
  return &step_m;
}
static int32_t init(void* self, const karst_parameter_value_t* values, uint64_t count, karst_error_t* error) {
  (void)error;
  if (count > 0) *(double*)self = values[0].number;
  return KARST_OK;
}
static int32_t activate(void* self, karst_error_t* error) {
  (void)self, (void)error;
  return KARST_OK;
}
static void deactivate(void* self) { (void)self; }
static void destroy(void* self) { (void)self; }

__attribute__((unused)) static karst_goal_t goal_ahead(const karst_request_t* r) {
  karst_goal_t g = {{0, 0, 0}, 0, 0, 0, 0, 0, 0, {0, 0}};
  g.position.x = r->state.position.x + step_m * r->direction_of_flight.x;
  g.position.y = r->state.position.y + step_m * r->direction_of_flight.y;
  g.position.z = r->state.position.z + step_m * r->direction_of_flight.z;
  g.tolerance_m = 0.5;
  g.score = 1;
  g.why.data = "ahead";
  g.why.length = 5;
  return g;
}
__attribute__((unused)) static int32_t answer(const karst_decision_sink_t* sink, const karst_goal_t* goals,
                                              uint64_t count, karst_error_t* error) {
  const karst_text_t none = {0, 0};
  const int32_t code = sink->add_goals(sink, goals, count, error);
  return code ? code : sink->set_outcome(sink, KARST_OUTCOME_GOALS, 0, none, error);
}

#ifdef DECIDE
static int32_t decide(void* self, const karst_request_t* r, const karst_decision_sink_t* sink,
                      karst_error_t* error) {
  DECIDE
}
#else
static int32_t decide(void* self, const karst_request_t* r, const karst_decision_sink_t* sink,
                      karst_error_t* error) {
  const karst_goal_t g = goal_ahead(r);
  (void)self;
  return answer(sink, &g, 1, error);
}
#endif

#ifndef ON_EVENT
#define ON_EVENT
#endif
#ifndef EXTENSION
#define EXTENSION 0
#endif
static int32_t on_event(void* self, const karst_event_t* event, karst_error_t* error) {
  (void)self, (void)event, (void)error;
  ON_EVENT
  return KARST_OK;
}

static const karst_parameter_t parameters[] = {{TEXT("step"),
                                                TEXT("m"),
                                                TEXT("how far ahead"),
                                                {0, 0},
                                                {0, 0},
                                                DEFAULT_STEP,
                                                0.1,
                                                10.0,
                                                KARST_PARAMETER_REAL,
                                                0}};
static const karst_policy_descriptor_t descriptor = {sizeof(karst_policy_descriptor_t),
                                                     0,
                                                     TEXT(POLICY_ID),
                                                     TEXT("Plain"),
                                                     TEXT("1.2.3"),
                                                     MIN_HOST,
                                                     1,
                                                     parameters,
                                                     TEXT("Flies a metre ahead.")};
#ifndef DECIDE_SLOT
#define DECIDE_SLOT decide
#endif
static const karst_policy_t policy_table = {TABLE_SIZE,  0,        &descriptor, create,  init,     activate,
                                            DECIDE_SLOT, on_event, deactivate,  destroy, EXTENSION};

static const karst_policy_t* policy(uint32_t index) { return index == 0 ? &policy_table : 0; }
static const karst_plugin_t plugin = {sizeof(karst_plugin_t), ABI_MAJOR, ABI_MINOR, 1, policy};

KARST_EXPORT const karst_plugin_t* karst_plugin_entry(void) KARST_NOEXCEPT {
  (void)decide;
  return &plugin;
}
