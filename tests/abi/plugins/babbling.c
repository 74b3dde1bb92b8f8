/* Gives a megabyte of bytes that are no text as its reason. */
#include <string.h>
static char noise[1 << 20];
#define DECIDE                                       \
  const karst_text_t reason = {noise, sizeof noise}; \
  (void)self, (void)r;                               \
  memset(noise, 0xfe, sizeof noise);                 \
  return sink->set_outcome(sink, KARST_OUTCOME_HOLD, 0, reason, error);
#include "plain.h"
