/* Wants to be flown so slowly that its goals are never reached. */
#define DECIDE                                                       \
  static const double speeds_mps[] = {1e-9, 1e-4, 0.1};              \
  karst_goal_t goals[3];                                             \
  (void)self;                                                        \
  for (int i = 0; i < 3; ++i) {                                      \
    goals[i] = goal_ahead(r);                                        \
    goals[i].max_speed_mps = speeds_mps[(i + (int)r->sequence) % 3]; \
  }                                                                  \
  return answer(sink, goals, 3, error);
#include "plain.h"
