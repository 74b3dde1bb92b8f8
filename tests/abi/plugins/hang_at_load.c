#include <unistd.h>
#include "plain.h"
__attribute__((constructor)) static void hang(void) {
  for (;;) pause();
}
