#include <fenv.h>
#include <locale.h>
#include "plain.h"
__attribute__((constructor)) static void change_locale_and_rounding(void) {
  setlocale(LC_ALL, "C.UTF-8");
  fesetround(FE_UPWARD);
}
