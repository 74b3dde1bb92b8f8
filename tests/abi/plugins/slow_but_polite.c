/* Takes for ever, but asks. Then tries the sink and the map once more, and writes what it was told to a file
   named by its environment. */
#include <stdio.h>
#include <stdlib.h>
#include <threads.h>
#include <time.h>
#define DECIDE                                                    \
  const struct timespec pause = {0, 1000000};                     \
  karst_map_info_t info;                                          \
  int32_t code;                                                   \
  FILE* out;                                                      \
  (void)self, (void)sink;                                         \
  while (!the_host->should_stop(the_host)) thrd_sleep(&pause, 0); \
  code = the_host->map->info(the_host, r->map, &info, error);     \
  out = fopen(getenv("KARST_TEST_NOTE"), "w");                    \
  fprintf(out, "%d", code);                                       \
  fclose(out);                                                    \
  return KARST_OK;
#include "plain.h"
