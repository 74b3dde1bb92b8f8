#define MIN_HOST \
  { 99, 0, 0 }
#include "plain.h"
