// The records of a run directory, as `karst report` reads them: whatever stands in them, they are read as far
// as they make sense. The first byte says which file it is.
#include <array>
#include <filesystem>

#include "sdk/evaluation/record/run_record.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kFiles{"mission.info",    "events.jsonl",       "telemetry.csv",  "map_growth.bin",
                              "decisions.csv",   "truth_events.jsonl", "trajectory.tum", "timing.json",
                              "evaluation.json", "truth_objects.jsonl"};
  if (size == 0) return 0;
  namespace fs = std::filesystem;
  const fs::path folder = "/dev/shm/karst_fuzz_run_" + std::to_string(getpid());
  fs::create_directories(folder);
  const std::string from = karst::fuzz::as_file(data + 1, size - 1, "");
  const fs::path file = folder / kFiles[data[0] % kFiles.size()];
  fs::rename(from, file);
  karst::evaluation::read_run(folder);
  fs::remove(file);
  return 0;
}
