/* Writes to address zero. */
#define DECIDE                                  \
  (void)self, (void)r, (void)sink, (void)error; \
  *(int* volatile)0 = 1;                        \
  return KARST_OK;
#include "plain.h"
