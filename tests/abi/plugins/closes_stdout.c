/* Closes stdout and stderr, and prints on. */
#include <stdio.h>
#include <unistd.h>
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  puts("open");                         \
  close(STDOUT_FILENO);                 \
  close(STDERR_FILENO);                 \
  puts("closed");                       \
  fputs("closed\n", stderr);            \
  return answer(sink, &g, 1, error);
#include "plain.h"
