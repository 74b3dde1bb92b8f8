/* Writes 4 MB to stdout and stderr before it answers. */
#include <stdio.h>
#define DECIDE                                          \
  const karst_goal_t g = goal_ahead(r);                 \
  (void)self;                                           \
  for (int i = 0; i < 1 << 16; ++i) {                   \
    fputs("0123456789012345678901234567890\n", stdout); \
    fputs("0123456789012345678901234567890\n", stderr); \
  }                                                     \
  fflush(stdout);                                       \
  return answer(sink, &g, 1, error);
#include "plain.h"
