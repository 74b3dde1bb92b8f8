#include <math.h>
#define DECIDE                    \
  karst_goal_t g = goal_ahead(r); \
  (void)self;                     \
  g.score = NAN;                  \
  return answer(sink, &g, 1, error);
#include "plain.h"
