/* Calls itself without end. */
#pragma GCC diagnostic ignored "-Winfinite-recursion"
static int deeper(volatile char* above) {
  volatile char here[4096];
  here[0] = above[0];
  return deeper(here) + here[0];
}
#define DECIDE                                  \
  volatile char top[1] = {1};                   \
  (void)self, (void)r, (void)sink, (void)error; \
  return deeper(top);
#include "plain.h"
