/* Answers well, and crashes when it is told what became of it. */
#define ON_EVENT *(int* volatile)0 = 1;
#include "plain.h"
