/* A table that ends before destroy. */
#include <stddef.h>
#define TABLE_SIZE offsetof(karst_policy_t, destroy)
#include "plain.h"
