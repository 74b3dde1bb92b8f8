// What the program is asked for: from its arguments, and from the run that it compares with.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "plugins/simulator/simulator_options.h"
#include "sdk/evaluation/record/run_record.h"
#include "tests/benchmark/offline_bound/tour_search.h"

namespace karst::bound {

constexpr const char* kUsage =
    "usage: offline_bound (--cave CAVE.info | --run RUN [--run RUN...]) [--horizon 180] [--until 120]\n"
    "         [--speed 2] [--acceleration 2] [--spacing 1] [--restarts 3] [--rounds 200000] [--seed 1] "
    "[--csv FILE]\n";

struct Flown {
  evaluation::RunRecord record;
  nlohmann::json metrics;
  double begin_s = 0, explored_s = 0;  // of take-off; when it stopped exploring
  double speed_mps = 0;                // mean while it explored
  TourTiming timing;                   // its times and limits
};

struct Arguments {
  std::string cave, start, csv;
  std::vector<Flown> runs;  // all in one cave
  sim::SimulatorOptions vehicle;
  double mapping_range_m = 30;
  TourTiming timing;  // without a run
  double spacing_m = 1;
  int restarts = 3;
  SearchOptions search;
  std::uint64_t seed = 1;
};

/// A number given as an argument wins over that of the run. Throws InputError, and std::invalid_argument with
/// the usage.
Arguments arguments_of(int argc, char** argv);

}  // namespace karst::bound
