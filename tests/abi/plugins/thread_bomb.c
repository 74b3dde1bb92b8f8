/* Starts threads as long as it can, and waits for them. */
#include <pthread.h>
#include <unistd.h>
static void* wait_for_ever(void* nothing) {
  for (;;) pause();
  return nothing;
}
static void bomb(void) {
  pthread_attr_t small;
  pthread_t thread;
  pthread_attr_init(&small);
  pthread_attr_setstacksize(&small, 65536);
  for (;;)
    if (pthread_create(&thread, &small, wait_for_ever, 0)) pause();
}
#define DECIDE                                  \
  (void)self, (void)r, (void)sink, (void)error; \
  bomb();                                       \
  return KARST_OK;
#include "plain.h"
