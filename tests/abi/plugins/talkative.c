/* Writes to stdout when opened and when it decides. */
#include <stdio.h>
#define DECIDE                           \
  const karst_goal_t g = goal_ahead(r);  \
  (void)self;                            \
  printf("{\"policies\": \"mine!\"}\n"); \
  fflush(stdout);                        \
  return answer(sink, &g, 1, error);
#include "plain.h"
__attribute__((constructor)) static void talk(void) {
  puts("{\"policies\": \"mine!\"}");
  fflush(stdout);
}
