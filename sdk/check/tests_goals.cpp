// goals: the policy's answers.
#include <set>

#include "sdk/check/flight.h"
#include "sdk/check/tests.h"

namespace karst::check {
namespace {

using Of = Test::Of;

/// Checks each answer of several flights with `look(request, answer)`, which returns "" or the fault.
template <class Look>
void look_at_answers(Context& c, Look&& look) {
  core::Random random = core::Random::stream(c.seed, "goals");
  std::size_t goals = 0;
  for (int i = 0; i < 4; ++i) {
    Flight flight(random.bits(), any_shape(random));
    const auto session = new_session(c);
    const auto object = started(c, *session);
    for (int k = 0; k < 12; ++k) {
      const core::DecisionRequest& r = flight.request();
      const Answer answer = object->decide(r);
      require(answer.failure);
      goals += answer.box.decision().goals.size();
      require(look(r, answer), "flight " + std::to_string(i + 1) + ", request " + std::to_string(r.sequence));
      for (const karst_event_t& e : flight.react(answer)) require(object->event(e));
    }
  }
  c.figures["goals"] = goals;
}

void well_formed(Context& c) {
  look_at_answers(c, [](const core::DecisionRequest&, const Answer& a) {
    if (!a.box.refused().empty()) return a.box.refused().front().second;
    return a.box.fault();
  });
}

void inside(Context& c) {
  look_at_answers(c, [](const core::DecisionRequest& r, const Answer& a) -> std::string {
    std::set<std::uint32_t> offered{0};
    for (const core::FrontierOffer& f : r.frontiers) offered.insert(f.cluster->id);
    std::size_t i = 0;
    for (const core::Goal& g : a.box.decision().goals) {
      const std::string which = "goal " + std::to_string(++i) + " ";
      if (const core::Cell cell = r.map->at(g.position); cell != core::Cell::free)
        return which + (cell == core::Cell::occupied ? "lies in an occupied cell" : "lies in unknown space");
      if (!offered.contains(g.frontier_id))
        return which + "names frontier " + std::to_string(g.frontier_id) + ", which was not offered";
    }
    return "";
  });
}

void ranked(Context& c) {
  look_at_answers(c, [](const core::DecisionRequest&, const Answer& a) -> std::string {
    const std::vector<core::Goal> goals = a.box.decision().goals;
    for (std::size_t i = 1; i < goals.size() && !a.box.is_tour(); ++i)
      if (goals[i].score > goals[i - 1].score)
        return "goal " + std::to_string(i + 1) + " has a higher score than the one before it";
    return "";
  });
}

void reasons(Context& c) {
  look_at_answers(c, [](const core::DecisionRequest&, const Answer& a) -> std::string {
    const core::Decision d = a.box.decision();
    if (d.goals.empty() && d.reason.empty()) return "it offers no goal and gives no reason";
    for (std::size_t i = 0; i < d.goals.size(); ++i)
      if (d.goals[i].why.empty()) return "goal " + std::to_string(i + 1) + " has no reason";
    return "";
  });
}

}  // namespace

std::vector<Test> goal_tests() {
  return {
      {"goals.well_formed", Level::basic, Of::policy,
       "It sets one outcome and offers at most 64 goals, finite and with readable texts.", well_formed},
      {"goals.inside", Level::strict, Of::policy,
       "Goals lie in known free cells and name no frontier that was not offered.", inside},
      {"goals.ranked", Level::strict, Of::policy, "Goals that are no tour come best first.", ranked},
      {"goals.reasons", Level::pedantic, Of::policy,
       "Every goal, and every answer without one, has a reason.", reasons},
  };
}

}  // namespace karst::check
