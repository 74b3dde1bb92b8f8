// entry.exports, and entry.described: it does not say what it does.
#include "tests/check/plugins/good.h"

extern "C" __attribute__((visibility("default"))) int one_more();
extern "C" __attribute__((visibility("default"))) int one_more() { return 1; }

KARST_POLICY(karst::test::Good, "exports_more", "1.0.0", "")
