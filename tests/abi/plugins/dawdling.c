/* Takes a second to hear of anything. */
#include <time.h>
#define ON_EVENT                         \
  const struct timespec second = {1, 0}; \
  nanosleep(&second, 0);
#include "plain.h"
