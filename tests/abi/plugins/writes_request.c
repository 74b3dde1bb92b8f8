/* Writes into what it was given to read. */
#define DECIDE                                                                          \
  const karst_goal_t g = goal_ahead(r);                                                 \
  (void)self;                                                                           \
  ((karst_request_t*)r)->stamp_ns = -1;                                                 \
  if (r->frontier_count) ((karst_frontier_cluster_t*)r->frontiers)->centroid.x = 1e300; \
  ((karst_request_t*)r)->frontiers = 0;                                                 \
  ((karst_request_t*)r)->frontier_count = 1u << 30;                                     \
  return answer(sink, &g, 1, error);
#include "plain.h"
