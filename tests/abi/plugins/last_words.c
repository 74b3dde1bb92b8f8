/* Says in colour what it is asked, and crashes from its third request on, in the middle of a line. */
#include <stdio.h>
#define DECIDE                                                  \
  const karst_goal_t g = goal_ahead(r);                         \
  (void)self;                                                   \
  printf("\033[31mrequest %u\033[0m\n", (unsigned)r->sequence); \
  if (r->sequence > 2) fputs("about to crash", stderr);         \
  if (r->sequence > 2) *(int* volatile)0 = 1;                   \
  return answer(sink, &g, 1, error);
#include "plain.h"
