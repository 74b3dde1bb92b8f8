#define DEFAULT_STEP 99.0
#include "plain.h"
