#include <unistd.h>
#include "plain.h"
__attribute__((constructor)) static void leave(void) { _exit(0); }
