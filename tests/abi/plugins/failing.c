/* Fails when the sequence number is odd or above ten: never three times in a row up to then. */
#include <string.h>
#define DECIDE                                      \
  if (r->sequence % 2 == 1 || r->sequence > 10) {   \
    (void)self, (void)sink;                         \
    error->code = KARST_ERROR_FAILED;               \
    strcpy(error->text, "the stars are not right"); \
    return KARST_ERROR_FAILED;                      \
  }                                                 \
  {                                                 \
    const karst_goal_t g = goal_ahead(r);           \
    return answer(sink, &g, 1, error);              \
  }
#include "plain.h"
