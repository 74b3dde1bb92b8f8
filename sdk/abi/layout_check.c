/* Compiles only if every struct of the ABI has the memory layout listed in karst_abi_layout.inc. */
#include "karst_abi.h"
#include "karst_abi_imaged.h"
#include "karst_abi_survey.h"

_Static_assert(sizeof(void*) == 8, "the policy ABI is defined for 64-bit platforms");

#define KARST_SIZE(type, bytes) _Static_assert(sizeof(struct type) == (bytes), "size of " #type);
#define KARST_FIELD(type, field, offset) \
  _Static_assert(offsetof(struct type, field) == (offset), "offset of " #type "." #field);
#include "karst_abi_layout.inc"
