/* Offers too many goals and claims success all the same. */
#include <stdlib.h>
#define DECIDE                                                      \
  const karst_text_t none = {0, 0};                                 \
  karst_goal_t g = goal_ahead(r);                                   \
  (void)self;                                                       \
  for (int i = 0; i < 65; ++i) sink->add_goals(sink, &g, 1, error); \
  sink->set_outcome(sink, KARST_OUTCOME_GOALS, 0, none, error);     \
  return KARST_OK;
#include "plain.h"
