/* Three goals, of which only the second is well formed. */
#include <math.h>
#define DECIDE                        \
  karst_goal_t g[3];                  \
  (void)self;                         \
  g[0] = g[1] = g[2] = goal_ahead(r); \
  g[0].position.y = NAN;              \
  g[2].why.data = "\xff";             \
  g[2].why.length = 1;                \
  return answer(sink, g, 3, error);
#include "plain.h"
