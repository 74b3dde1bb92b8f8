/* Takes memory and writes to it until there is none, and does not look at what malloc returns. */
#include <stdlib.h>
#include <string.h>
#define DECIDE                                      \
  (void)self, (void)r, (void)sink, (void)error;     \
  for (;;) memset(malloc(64u << 20), 1, 64u << 20); \
  return KARST_OK;
#include "plain.h"
