#include <locale.h>
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  setlocale(LC_ALL, "C.UTF-8");         \
  return answer(sink, &g, 1, error);
#include "plain.h"
