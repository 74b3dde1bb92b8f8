/*
 * Asks how far it is to thousands of places that may be approached from anywhere, again and again: known free
 * space as near to rock as can be, where nothing is clear.
 */
#include <stdlib.h>
#define DECIDE                                                                                           \
  static karst_vec3_t surface[4096], places[4096];                                                       \
  static double lengths[4096];                                                                           \
  const karst_vec3_t p = r->state.position;                                                              \
  const karst_box_t box = {{p.x - 40, p.y - 40, p.z - 40}, {p.x + 40, p.y + 40, p.z + 40}};              \
  karst_map_info_t info;                                                                                 \
  uint64_t total = 0, n = 0;                                                                             \
  const karst_goal_t g = goal_ahead(r);                                                                  \
  (void)self;                                                                                            \
  if (the_host->map->info(the_host, r->map, &info, error)) return KARST_ERROR_FAILED;                    \
  if (the_host->map->surface_cells(the_host, r->map, box, surface, 4096, &total, error)) return 1;       \
  if (total > 4096) total = 4096;                                                                        \
  for (uint64_t i = 0; i < 6 * total && n < 4096; ++i) {                                                 \
    double* const axis = &places[n].x + i % 3;                                                           \
    karst_cell_t cell = KARST_CELL_UNKNOWN;                                                              \
    places[n] = surface[i / 6];                                                                          \
    *axis += (i % 6 < 3 ? 1 : -1) * info.resolution_m;                                                   \
    the_host->map->cell_states(the_host, r->map, &places[n], 1, &cell, error);                           \
    n += cell == KARST_CELL_FREE;                                                                        \
  }                                                                                                      \
  for (int i = 0; i < 3; ++i)                                                                            \
    the_host->path->lengths(the_host, p, places, i == 0 ? (n < 16 ? n : 16) : n, 100.0, lengths, error); \
  return answer(sink, &g, 1, error);
#include "plain.h"
