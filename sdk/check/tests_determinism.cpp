// determinism: equal requests give equal answers.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "sdk/check/flight.h"
#include "sdk/check/tests.h"
#include "sdk/check/watched_host.h"
#include "sdk/host/isolation/process.h"

namespace karst::check {
namespace {

using Of = Test::Of;
namespace fs = std::filesystem;

const CaveShape kShape{.volume_m3 = 200, .radius_m = 1.6, .branches = 4, .resolution_m = 0.2};

std::string answers(Context& c, const karst_host_t* host, host::Session& session, int count) {
  Flight flight(c.seed, kShape);
  const auto object = started(c, session, host);
  return text_of(fly(*object, flight, count));
}

void require_same(const std::string& a, const std::string& b, const std::string& when) {
  if (a == b) return;
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && a[i] == b[i]) ++i;
  const std::size_t request = a.rfind("request ", i);
  throw Failed{
      "it answers differently " + when + ", first at " +
      (request == std::string::npos ? "the start" : a.substr(request, a.find('\n', request) - request))};
}

void repeat(Context& c) {
  const std::string first = answers_to_compare(c);
  for (int i = 0; i < 2; ++i) require_same(first, answers_to_compare(c), "when asked the same again");
}

void fresh_process(Context& c) {
  const fs::path file = fs::temp_directory_path() / ("karst-answers-" + std::to_string(getpid()));
  // Addresses differ anyway; the time zone, the size of the environment and the folder are changed here.
  const std::vector<std::string> argv = {"/usr/bin/env",
                                         "-C",
                                         "/",
                                         "TZ=Asia/Kathmandu",
                                         "LC_NUMERIC=de_DE.UTF-8",
                                         "KARST_CHECK=" + std::string(300, 'x'),
                                         c.karst,
                                         "policy",
                                         "check-answers",
                                         fs::absolute(c.file).string(),
                                         "--policy",
                                         c.id,
                                         "--seed",
                                         std::to_string(c.seed),
                                         "--out",
                                         file.string()};
  const host::ProcessOutput done = host::run_process(argv, 300);
  std::ifstream in(file, std::ios::binary);
  const std::string there{std::istreambuf_iterator<char>(in), {}};
  in.close();
  fs::remove(file);
  if (done.end.exit_code != 0 || done.end.signal != 0 || done.end.hung)
    throw Failed{"a second process that asks it: " + host::describe(done.end)};
  require_same(answers_to_compare(c), there, "in another process");
}

void slow_host(Context& c) {
  const auto session = new_session(c);
  const std::string fast = answers(c, nullptr, *session, 4);
  const auto slow_session = new_session(c);
  WatchedHost slow(*slow_session->host());
  std::atomic<int> paused = 0;
  slow.before = [&](const char*) {  // only the first few calls take long; a thousand would take minutes
    if (++paused <= 20) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return std::int32_t{KARST_OK};
  };
  require_same(fast, answers(c, slow.host(), *slow_session, 4), "when the host takes its time");
}

}  // namespace

std::string answers_to_compare(Context& context) {
  const auto session = new_session(context);
  return answers(context, nullptr, *session, 15);
}

std::vector<Test> determinism_tests() {
  return {
      {"determinism.repeat", Level::basic, Of::policy,
       "A new object that is asked the same gives the same answers, to the last digit.", repeat},
      {"determinism.fresh_process", Level::basic, Of::policy,
       "It gives the same answers in another process, with other addresses, environment and working folder.",
       fresh_process},
      {"determinism.slow_host", Level::strict, Of::policy,
       "It gives the same answers when services take long.", slow_host},
  };
}

}  // namespace karst::check
