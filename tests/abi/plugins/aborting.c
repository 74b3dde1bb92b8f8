/* A failed assertion. */
#include <stdlib.h>
#define DECIDE                                  \
  (void)self, (void)r, (void)sink, (void)error; \
  abort();                                      \
  return KARST_OK;
#include "plain.h"
