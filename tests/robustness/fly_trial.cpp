#include "tests/robustness/fly_trial.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

namespace karst::robustness {
namespace {

namespace fs = std::filesystem;

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", v);
  return text;
}

/// The mission's time that a flight under way has come to, by its ground truth, which is flushed every
/// second.
double time_flown_s(const fs::path& run_dir) {
  std::ifstream in(run_dir / "truth.csv");
  std::string line, last;
  while (std::getline(in, line))
    if (!in.eof()) last = line;
  return std::strtod(last.c_str(), nullptr);
}

}  // namespace

std::vector<std::string> command_of(const Trial& t, const Programs& programs, const fs::path& cave,
                                    const fs::path& cave_cache, const fs::path& run_dir) {
  std::vector<std::string> argv;
  if (t.fault == Fault::disk_full) argv = {"/usr/bin/prlimit", "--fsize=" + std::to_string(t.disk_bytes)};
  argv.insert(argv.end(), {programs.karst.string(), "fly", "--quiet", "--no-report", "--threads", "1"});
  const auto set = [&argv](const std::string& setting) { argv.insert(argv.end(), {"--set", setting}); };
  argv.insert(argv.end(), {"--cave", cave.string(), "--seed", std::to_string(t.number)});
  argv.insert(argv.end(), {"--cave-cache", cave_cache.string(), "--out", run_dir.string()});
  const bool breaks = t.fault == Fault::policy_crash || t.fault == Fault::policy_hang;
  argv.insert(argv.end(), {"--policy", breaks ? "breaks_later" : t.policy});
  if (breaks) {
    argv.insert(argv.end(), {"--plugin", programs.breaking_policy.string()});
    set("policy.parameters.after=" + number(t.fault_at_s) + " s");
    set("policy.parameters.how=" + t.what);
    set("policy.cpu_limit=2 s");
    set("policy.hang_limit=20 s");
  }
  set(std::string("policy.isolation=") + (t.own_process ? "process" : "in_process"));
  set("simulator.vehicle=" + t.vehicle);
  set("simulator.gust=3 m/s");
  set("simulator.air.haze=" + number(t.haze_1pm));
  set("simulator.air.stirred=" + number(t.stirred_1pm));
  set("mission.max_flight_time=" + number(t.flight_s) + " s");
  set("mission.home_reserve=8 s");
  if (!breaks && t.policy == "surface_coverage") set("simulator.rgb.fitted=true");
  if (t.fault == Fault::weak_motor) {
    set("simulator.motors.weak=" + std::to_string(t.motor));
    set("simulator.motors.weak_after=" + number(t.fault_at_s) + " s");
  }
  if (t.fault == Fault::radio_silence) {
    set("team.robots=" + std::to_string(t.robots));
    set("team.stagger=12 s");
    set("team.linger=5 s");
    set("radio.silent_after=" + number(t.fault_at_s) + " s");
    set("radio.silent_for=" + number(t.fault_for_s) + " s");
  }
  return argv;
}

host::ProcessEnd fly_trial(const Trial& trial, const std::vector<std::string>& command,
                           const fs::path& run_dir, const fs::path& log, double limit_s) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  host::ProcessEnd end;
  const pid_t pid = host::start_process(command, log);
  for (bool warned = trial.fault != Fault::sigterm; !host::has_ended(pid, end);) {
    if (std::chrono::duration<double>(Clock::now() - begin).count() > limit_s) {
      host::end_process(pid);
      end.hung = true;
      break;
    }
    if (!warned && time_flown_s(run_dir) >= trial.fault_at_s) {
      kill(pid, SIGTERM);
      warned = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  end.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  return end;
}

}  // namespace karst::robustness
