// process: shared state of the process that the policy must not change.
#include "sdk/check/flight.h"
#include "sdk/check/process_view.h"
#include "sdk/check/tests.h"

namespace karst::check {
namespace {

using Of = Test::Of;

const CaveShape kSmallShape{.volume_m3 = 150, .radius_m = 1.6, .branches = 3, .resolution_m = 0.2};

/// Runs a policy's whole life cycle. Returns the changes that its calls made to the process.
std::vector<std::string> live(Context& c) {
  const auto session = new_session(c);
  Flight flight(c.seed, kSmallShape);
  const auto object = started(c, *session);
  fly(*object, flight, 8);
  require(object->deactivate());
  require(object->destroy());
  return object->changes();
}

void output(Context& c) {
  const ProcessView before;
  live(c);
  if (const std::string written = before.output_since(); !written.empty())
    throw Failed{written + ": use request.log(); printing is fine while you develop"};
}
void arithmetic(Context& c) {
  if (const std::vector<std::string> changes = live(c); !changes.empty()) throw Failed{changes.front()};
}
void signals(Context& c) {
  const ProcessView before;
  live(c);
  require(before.signals_since());
}
void leftovers(Context& c) {
  const ProcessView before;
  live(c);
  require(before.leftovers_since());
}

}  // namespace

std::vector<Test> process_tests() {
  return {
      {"process.output", Level::pedantic, Of::policy,
       "It writes nothing to standard output or standard error.", output, true},
      {"process.locale_and_arithmetic", Level::strict, Of::policy,
       "No call leaves another locale or other rules of floating-point arithmetic.", arithmetic},
      {"process.signals", Level::strict, Of::policy, "It takes over no signal and blocks none.", signals},
      {"process.leftovers", Level::pedantic, Of::policy,
       "It leaves no file open, and working folder, file mode mask and environment as they were.", leftovers},
  };
}

}  // namespace karst::check
