/* Stops its process, as Ctrl-Z would. */
#include <signal.h>
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  raise(SIGSTOP);                       \
  return answer(sink, &g, 1, error);
#include "plain.h"
