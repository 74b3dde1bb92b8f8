#define ABI_MINOR 7
#include "plain.h"
