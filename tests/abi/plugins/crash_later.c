/* Answers well twice, then crashes whenever it is asked. */
#define DECIDE                                \
  const karst_goal_t g = goal_ahead(r);       \
  (void)self;                                 \
  if (r->sequence > 2) *(int* volatile)0 = 1; \
  return answer(sink, &g, 1, error);
#include "plain.h"
