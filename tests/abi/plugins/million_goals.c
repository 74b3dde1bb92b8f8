#include <stdlib.h>
#define DECIDE                                               \
  const uint64_t count = 1000000;                            \
  karst_goal_t* g = malloc(count * sizeof *g);               \
  int32_t code;                                              \
  (void)self;                                                \
  for (uint64_t i = 0; i < count; ++i) g[i] = goal_ahead(r); \
  code = answer(sink, g, count, error);                      \
  free(g);                                                   \
  return code;
#include "plain.h"
