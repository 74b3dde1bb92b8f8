/* Answers at once, and leaves threads behind that compute for ever and ignore the limit's signal. */
#include <pthread.h>
#include <signal.h>
static volatile unsigned long counted;
static void* count_for_ever(void* nothing) {
  for (;;) ++counted;
  return nothing;
}
static void begin(void) {
  static int begun;
  pthread_t thread;
  int i;
  if (begun++) return;
  signal(SIGXCPU, SIG_IGN);
  for (i = 0; i < 4; ++i) pthread_create(&thread, 0, count_for_ever, 0);
}
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  begin();                              \
  return answer(sink, &g, 1, error);
#include "plain.h"
