/* Finds the shared memory of its process and fills it with garbage, before it answers. */
#define _DEFAULT_SOURCE
#include <stdio.h>
#include <string.h>
#include <unistd.h>
static void scribble(void) {
  char line[512], mode[8];
  unsigned long low, high;
  FILE* maps = fopen("/proc/self/maps", "r");
  while (maps && fgets(line, sizeof line, maps))
    if (strstr(line, "memfd:karst-policy") && sscanf(line, "%lx-%lx %7s", &low, &high, mode) == 3 &&
        mode[1] == 'w')
      memset((void*)low, 0x5a, high - low);
  if (maps) fclose(maps);
  usleep(200000); /* so that the host looks before the answer mends the counts */
}
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  scribble();                           \
  return answer(sink, &g, 1, error);
#include "plain.h"
