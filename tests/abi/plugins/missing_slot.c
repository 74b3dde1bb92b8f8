#define DECIDE_SLOT 0
#include "plain.h"
