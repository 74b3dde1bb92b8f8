#include <signal.h>
#include "plain.h"
__attribute__((constructor)) static void crash(void) {
  signal(SIGSEGV, SIG_DFL);
  volatile int* volatile nowhere = 0;
  *nowhere = 1;
}
