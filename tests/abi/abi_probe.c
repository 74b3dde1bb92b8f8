/*
 * For abidiff only: a library whose exported functions take every struct of the ABI by pointer. Of a plugin
 * itself abidiff sees nothing, because its tables are reached through a factory.
 */
#include "karst_abi.h"
#include "karst_abi_imaged.h"
#include "karst_abi_survey.h"

#define PROBE(type)                                           \
  KARST_EXPORT const void* karst_probe_##type(const type* x); \
  const void* karst_probe_##type(const type* x) { return x; }

PROBE(karst_text_t)
PROBE(karst_error_t)
PROBE(karst_vec3_t)
PROBE(karst_quaternion_t)
PROBE(karst_pose_t)
PROBE(karst_box_t)
PROBE(karst_segment_t)
PROBE(karst_state_t)
PROBE(karst_viewpoint_t)
PROBE(karst_frontier_cluster_t)
PROBE(karst_teammate_t)
PROBE(karst_sensor_t)
PROBE(karst_goal_t)
PROBE(karst_map_info_t)
PROBE(karst_ray_end_t)
PROBE(karst_cell_counts_t)
PROBE(karst_passage_end_t)
PROBE(karst_passage_t)
PROBE(karst_passage_place_t)
PROBE(karst_map_service_t)
PROBE(karst_path_t)
PROBE(karst_path_service_t)
PROBE(karst_gain_service_t)
PROBE(karst_draw_service_t)
PROBE(karst_host_t)
PROBE(karst_parameter_t)
PROBE(karst_parameter_value_t)
PROBE(karst_policy_descriptor_t)
PROBE(karst_request_t)
PROBE(karst_decision_sink_t)
PROBE(karst_event_t)
PROBE(karst_policy_t)
PROBE(karst_plugin_t)
PROBE(karst_state_sink_t)
PROBE(karst_state_extension_t)
PROBE(karst_imaged_camera_t)
PROBE(karst_surface_cell_t)
PROBE(karst_imaged_service_t)
PROBE(karst_survey_size_t)
PROBE(karst_survey_leg_t)
PROBE(karst_survey_lead_t)
PROBE(karst_survey_service_t)
