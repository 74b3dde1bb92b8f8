// services: use of the host's services, and behaviour if the host fails.
#include <set>

#include "sdk/check/flight.h"
#include "sdk/check/process_view.h"
#include "sdk/check/tests.h"
#include "sdk/check/watched_host.h"

namespace karst::check {
namespace {

using Of = Test::Of;

constexpr const char* kServices[] = {
    "map.info",   "map.cell_states",       "map.cast_rays", "map.count_in_boxes", "map.surface_cells",
    "map.retain", "map.distances_to_rock", "map.passages",  "map.passages_at",    "path.lengths",
    "path.paths", "gain.newly_seen",       "draw.points",   "draw.lines",         "draw.text"};

void rules(Context& c) {
  const auto session = new_session(c);
  WatchedHost host(*session->host());
  Flight flight(c.seed, kShape);
  const auto object = started(c, *session, host.host());
  fly(*object, flight, 20);
  c.figures["calls"] = host.calls();
  if (const std::vector<std::string> refused = host.refusals(); !refused.empty())
    throw Failed{refused.front()};
}

void fail(Context& c) {
  for (const char* service : kServices)
    for (const std::int32_t code : {KARST_ERROR_FAILED, KARST_ERROR_LIMIT, KARST_ERROR_UNAVAILABLE}) {
      const auto session = new_session(c);
      WatchedHost host(*session->host());
      Flight flight(c.seed, kShape);
      const auto object = started(c, *session, host.host());
      fly(*object, flight, 1);
      bool failed = false;
      host.before = [&](const char* called) -> std::int32_t {
        const bool this_one = std::string(called) == service;
        failed |= this_one;
        return this_one ? code : KARST_OK;
      };
      const Answer answer = object->decide(flight.request());  // an error is accepted, and so is an answer
      if (answer.failure.find("exception across the border") != std::string::npos)
        throw Failed{std::string(service) + " failed: " + answer.failure};
      host.before = nullptr;
      require(object->decide(flight.request()).failure, std::string("once ") + service + " worked again");
      if (!failed) break;  // the policy does not use this service
    }
}

void absent(Context& c) {
  for (int missing = 0; missing < 3; ++missing) {
    const auto session = new_session(c);
    WatchedHost::Offer offer;
    (missing == 0 ? offer.path : missing == 1 ? offer.gain : offer.draw) = false;
    WatchedHost host(*session->host(), offer);
    Flight flight(c.seed, kShape);
    Object object(c, *session, host.host());
    if (!object.create_fault().empty() || !object.init(defaults(*c.policy)).empty() ||
        !object.activate().empty())
      continue;  // the policy may refuse such a host with a reason
    for (int i = 0; i < 2; ++i) {
      const Answer answer = object.decide(flight.request());
      if (answer.failure.find("exception across the border") != std::string::npos)
        throw Failed{answer.failure};
    }
  }
}

void threads(Context& c) {
  const ProcessView before;
  const auto session = new_session(c);
  WatchedHost host(*session->host());
  Flight flight(c.seed, kShape);
  for (int life = 0; life < 2; ++life) {
    const auto object = started(c, *session, host.host());
    fly(*object, flight, 5);
    require(object->deactivate());
    require(object->destroy());
  }
  host.close();
  require(before.threads_since(), "after destroy()");
  if (host.late_calls() > 0) throw Failed{"it called the host after it was destroyed"};
}

}  // namespace

std::vector<Test> service_tests() {
  return {
      {"services.rules", Level::strict, Of::policy,
       "The host refuses none of its calls: right thread, right time, arguments in range.", rules},
      {"services.fail", Level::basic, Of::policy,
       "A service that fails makes a decision fail at most, and the next one is made again.", fail},
      {"services.absent", Level::pedantic, Of::policy,
       "Without paths, gains or drawings it decides, or fails with a reason.", absent},
      {"threads.end", Level::basic, Of::policy,
       "Its threads have ended when destroy() returns, and none calls the host afterwards.", threads},
  };
}

}  // namespace karst::check
