/* Thinks the program is its own. */
#include <stdlib.h>
#define DECIDE                                  \
  (void)self, (void)r, (void)sink, (void)error; \
  _Exit(0);                                     \
  return KARST_OK;
#include "plain.h"
