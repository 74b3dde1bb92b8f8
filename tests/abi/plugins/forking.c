/* Forks; says in its goal what came of it. Never more than one child, which ends at once. */
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>
static int forks(void) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  if (child > 0) waitpid(child, 0, 0);
  return child > 0;
}
#define DECIDE                                        \
  karst_goal_t g = goal_ahead(r);                     \
  (void)self;                                         \
  g.why.data = forks() ? "forked" : "could not fork"; \
  g.why.length = g.why.data[0] == 'f' ? 6 : 14;       \
  return answer(sink, &g, 1, error);
#include "plain.h"
