#include "tests/benchmark/offline_bound/arguments.h"

#include <map>
#include <stdexcept>

#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/metrics/flight_figures.h"

namespace karst::bound {
namespace {

constexpr double kClimb_s = 2.8;  // of a flight with the default take-off height

Flown read_flown(const std::filesystem::path& folder) {
  Flown f;
  f.record = evaluation::read_run(folder);
  f.metrics = evaluation::read_json(folder / "metrics.json", f.record.problems);
  f.begin_s = evaluation::flight_begin_s(f.record);
  for (const evaluation::Phase& p : f.record.phases)
    if (p.is(core::Phase::explore)) f.explored_s = p.end_s;
  f.speed_mps = evaluation::flight_figures(f.record).exploring_speed_mps.value_or(0);
  if (!f.metrics.is_object() || !f.metrics["coverage"].is_number() || !(f.explored_s > f.begin_s) ||
      !(f.speed_mps > 0) || f.record.truth.empty())
    throw core::InputError(folder.string(), "",
                           "needs metrics.json, ground_truth.tum and a time of exploring");
  return f;
}

TourTiming timing_of(const Flown& f, TourTiming t) {
  const evaluation::RunRecord& r = f.record;
  t.speed_mps = r.number("motion.max_speed").value_or(t.speed_mps);
  t.acceleration_mps2 = r.number("motion.max_acceleration").value_or(t.acceleration_mps2);
  t.horizon_s = evaluation::horizon_s(r).value_or(t.horizon_s);
  t.end_s = f.explored_s - f.begin_s;
  for (const evaluation::Phase& p : r.phases)
    if (p.is(core::Phase::look) || p.is(core::Phase::explore)) {
      t.begin_s = p.begin_s - f.begin_s;
      break;
    }
  return t;
}

/// The cave and the sensors, of the first run.
void take_from_run(Arguments& a) {
  const evaluation::RunRecord& r = a.runs.front().record;
  const std::string cave = r.setting("cave.file");
  for (const Flown& f : a.runs)
    if (f.record.setting("cave.file") != cave)
      throw core::InputError(f.record.directory.string(), "", "not in " + cave);
  if (a.cave.empty()) a.cave = cave, a.start = r.setting("cave.start");
  core::OptionTable table;
  table.section("simulator", a.vehicle);
  for (const evaluation::Setting& s : r.settings)
    if (s.key.starts_with("simulator.")) table.set((r.directory / "mission.info").string(), s.key, s.value);
  a.mapping_range_m = r.number("mission.mapping_range").value_or(a.mapping_range_m);
}

}  // namespace

Arguments arguments_of(int argc, char** argv) {
  Arguments a;
  std::map<std::string, std::string> given;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string_view(argv[i]) == "--run") {
      a.runs.push_back(read_flown(argv[i + 1]));
    } else {
      given[argv[i]] = argv[i + 1];
    }
  }
  if (argc % 2 == 0 || (a.runs.empty() && !given.contains("--cave"))) throw std::invalid_argument(kUsage);
  a.timing.begin_s = kClimb_s, a.timing.end_s = 120, a.timing.horizon_s = 180;
  const auto text = [&](const char* name, std::string& value) {
    if (const auto it = given.find(name); it != given.end()) value = it->second, given.erase(it);
  };
  const auto number = [&](const char* name, auto& value) {
    std::string digits;
    text(name, digits);
    if (!digits.empty()) value = static_cast<std::decay_t<decltype(value)>>(std::stod(digits));
  };
  text("--cave", a.cave);
  text("--csv", a.csv);
  if (!a.runs.empty()) take_from_run(a);
  std::vector<TourTiming*> timings{&a.timing};
  for (Flown& f : a.runs) f.timing = timing_of(f, a.timing), timings.push_back(&f.timing);
  for (TourTiming* t : timings) {
    const auto left = given;  // each of them takes the same
    number("--horizon", t->horizon_s);
    number("--until", t->end_s);
    number("--speed", t->speed_mps);
    number("--acceleration", t->acceleration_mps2);
    if (t != timings.back()) given = left;
  }
  number("--spacing", a.spacing_m);
  number("--restarts", a.restarts);
  number("--rounds", a.search.rounds);
  number("--seed", a.seed);
  if (!given.empty()) throw std::invalid_argument(kUsage);
  return a;
}

}  // namespace karst::bound
