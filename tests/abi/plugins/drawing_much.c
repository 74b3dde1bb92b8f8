/* Draws and logs as much as a decision may, in each. */
#include <stdlib.h>
#include <string.h>
#define DECIDE                                                                      \
  enum { kPoints = 200000 };                                                        \
  static karst_vec3_t points[kPoints];                                              \
  static char line[1000];                                                           \
  const karst_goal_t g = goal_ahead(r);                                             \
  const karst_text_t text = {line, sizeof line};                                    \
  (void)self;                                                                       \
  for (int i = 0; i < kPoints; ++i) {                                               \
    points[i] = r->state.position;                                                  \
    points[i].x += 1.0 / 3 * i;                                                     \
  }                                                                                 \
  memset(line, 'x', sizeof line);                                                   \
  the_host->draw->points(the_host, points, 1000, 0xff0000, error);                  \
  the_host->draw->points(the_host, points + 1000, kPoints - 1000, 0x00ff00, error); \
  for (int i = 0; i < 300; ++i) the_host->log(the_host, KARST_LOG_INFO, text);      \
  return answer(sink, &g, 1, error);
#include "plain.h"
