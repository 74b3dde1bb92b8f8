// mcap_interop FOLDER: writes a made-up run into FOLDER/run, and FOLDER/run.mcap. For interop_test.sh.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "sdk/mcap_export/export_mcap.h"
#include "tests/unit/evaluation/fake_run.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::remove_all(folder);
    karst::test::write_fake_run(folder / "run", {.length_m = 20});
    karst::mcap::export_mcap(folder / "run", folder / "run.mcap", {}, "test");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
