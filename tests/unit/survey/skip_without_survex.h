// For tests that need Survex.
#pragma once
#include <gtest/gtest.h>

#include "sdk/survey/cavern.h"

#define SKIP_WITHOUT_SURVEX() \
  if (!karst::survey::has_survex()) GTEST_SKIP() << "skipped: no survex"
