/* Computes for ever. */
#define DECIDE                                  \
  (void)self, (void)r, (void)sink, (void)error; \
  for (volatile unsigned i = 0;; ++i) {         \
  }                                             \
  return KARST_OK;
#include "plain.h"
