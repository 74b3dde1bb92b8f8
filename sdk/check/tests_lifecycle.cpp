// lifecycle and parameters: the order of calls, and every value that a mission file may set.
#include <cmath>
#include <limits>

#include "sdk/check/flight.h"
#include "sdk/check/tests.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/plugin/parameters.h"

namespace karst::check {
namespace {

using Of = Test::Of;

const CaveShape kSmall{.volume_m3 = 120, .radius_m = 1.6, .branches = 2, .resolution_m = 0.2};

std::string line_of(const karst_text_t& t) { return host::cleaned(t, host::kLogLineLimit); }

void order(Context& c) {
  const auto session = new_session(c);
  Flight flight(c.seed, kSmall);
  const auto object = started(c, *session);
  require(object->decide(flight.request()).failure);
  require(object->deactivate());
  require(object->destroy());
}

void destroy_anywhere(Context& c) {
  enum Stage { created, initialized, active, asked, told, rested, end };
  Flight flight(c.seed, kSmall);
  for (int stop = created; stop < end; ++stop) {
    const auto session = new_session(c);
    Object object(c, *session);
    require(object.create_fault());
    if (stop >= initialized) require(object.init(defaults(*c.policy)));
    if (stop >= active) require(object.activate());
    if (stop >= asked) {
      const Answer answer = object.decide(flight.request());
      require(answer.failure);
      if (stop >= told)
        for (const karst_event_t& e : flight.react(answer)) require(object.event(e));
    }
    if (stop >= rested) require(object.deactivate());
    require(object.destroy());
  }
}

void reactivate(Context& c) {
  const auto session = new_session(c);
  Flight flight(c.seed, kSmall);
  const auto object = started(c, *session);
  for (int i = 0; i < 3; ++i) {
    fly(*object, flight, 3);
    require(object->deactivate());
    require(object->activate(), "after deactivate()");
    require(object->deactivate());
    require(object->activate(), "a second time in a row");
  }
  fly(*object, flight, 3);
}

void events(Context& c) {
  const auto session = new_session(c);
  Flight flight(c.seed, kSmall);
  const auto object = started(c, *session);
  const std::string reason = "never heard of it";
  for (karst_event_kind_t kind : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 1000u, 0xffffffffu}) {
    require(object->decide(flight.request()).failure);
    karst_event_t e{};
    e.size = sizeof e;
    e.kind = kind;
    e.stamp_ns = flight.request().stamp;
    e.goal.tolerance_m = 0.5;
    e.goal.heading_rad = std::numeric_limits<double>::quiet_NaN();  // any heading
    e.goal.position = {1e4, -1e4, 50};                              // no policy proposed this goal
    e.goal.frontier_id = 0xfffffff0u;
    e.reason = host::view_of(reason);
    require(object->event(e));
    e.reason = {nullptr, 0};
    require(object->event(e));
  }
  require(object->decide(flight.request()).failure, "after all kinds of events");
}

void two_objects(Context& c) {
  std::string alone;
  {
    const auto session = new_session(c);
    Flight flight(c.seed, kSmall);
    alone = text_of(fly(*started(c, *session), flight, 8));
  }
  const auto session_a = new_session(c), session_b = new_session(c);
  Flight flight_a(c.seed, kSmall), flight_b(c.seed + 1, kSmall);
  const auto a = started(c, *session_a), b = started(c, *session_b);
  std::vector<Answer> answers;
  for (int i = 0; i < 8; ++i) {
    for (Answer& answer : fly(*a, flight_a, 1)) answers.push_back(std::move(answer));
    fly(*b, flight_b, 1);
  }
  if (text_of(answers) != alone)
    throw Failed{"it answers differently while another object of it is asked as well"};
}

/// Runs a short flight with these values; init() may refuse them with a reason.
void fly_with(Context& c, const std::vector<karst_parameter_value_t>& values, const std::string& what) {
  const auto session = new_session(c);
  Flight flight(c.seed, kSmall);
  Object object(c, *session);
  require(object.create_fault());
  const std::string refused = object.init(values);
  if (refused.find("exception across the border") != std::string::npos) throw Failed{what + ": " + refused};
  if (!refused.empty()) return;
  require(object.activate(), what);
  try {
    fly(object, flight, 3);
  } catch (const Failed& f) {
    throw Failed{what + ": " + f.reason};
  }
}

void bounds(Context& c) {
  std::size_t tried = 0;
  const karst_policy_descriptor_t& d = *c.policy->descriptor;
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    const karst_parameter_t& p = d.parameters[i];
    std::vector<karst_parameter_value_t> values = defaults(*c.policy);
    if (p.type == KARST_PARAMETER_TEXT) {
      for (const std::string& choice : host::split_choices(line_of(p.choices))) {
        values[i].text = host::view_of(choice);
        fly_with(c, values, line_of(p.id) + " = " + choice);
        ++tried;
      }
      continue;
    }
    const bool flag = p.type == KARST_PARAMETER_BOOLEAN;
    for (const double v : {flag ? 0.0 : p.low, flag ? 1.0 : p.high}) {
      values[i].number = v;
      char text[40];
      std::snprintf(text, sizeof text, " = %g", v);
      fly_with(c, values, line_of(p.id) + text);
      ++tried;
    }
  }
  c.figures["values_tried"] = tried;
  if (tried == 0) throw NotApplicable{"it declares no parameter with bounds"};
}

void texts(Context& c) {
  const std::string odd[] = {
      "",    " ",  "no such thing", std::string(1000, 'x'), "\xc3\xa4\xe2\x82\xac", "%s%n", "../..",
      "nan", "-1", "1e400"};
  bool any = false;
  const karst_policy_descriptor_t& d = *c.policy->descriptor;
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    if (d.parameters[i].type != KARST_PARAMETER_TEXT || d.parameters[i].choices.length > 0) continue;
    any = true;
    for (const std::string& text : odd) {
      std::vector<karst_parameter_value_t> values = defaults(*c.policy);
      values[i].text = host::view_of(text);
      fly_with(c, values, line_of(d.parameters[i].id) + " = \"" + text.substr(0, 20) + "\"");
    }
  }
  if (!any) throw NotApplicable{"it declares no parameter of free text"};
}

}  // namespace

std::vector<Test> lifecycle_tests() {
  return {
      {"lifecycle.order", Level::basic, Of::policy_gate,
       "With the declared defaults it is created, initialized and activated, decides, rests and is "
       "destroyed.",
       order},
      {"lifecycle.destroy", Level::basic, Of::policy, "It can be destroyed in every state of its life.",
       destroy_anywhere},
      {"lifecycle.reactivate", Level::basic, Of::policy,
       "It decides again after it was deactivated and activated, once or twice in a row.", reactivate},
      {"lifecycle.events", Level::basic, Of::policy,
       "It takes every kind of event, those of later versions and about goals it never proposed included.",
       events},
      {"lifecycle.two_objects", Level::strict, Of::policy,
       "Two objects side by side answer as each would alone.", two_objects},
      {"parameters.bounds", Level::basic, Of::policy,
       "Every bound and every choice of a parameter is flown with, or refused by init() with a reason.",
       bounds},
      {"parameters.texts", Level::strict, Of::policy,
       "Any text for a parameter of free text is flown with, or refused by init() with a reason.", texts},
  };
}

}  // namespace karst::check
