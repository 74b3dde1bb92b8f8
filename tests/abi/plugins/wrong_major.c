#define ABI_MAJOR 2
#include "plain.h"
