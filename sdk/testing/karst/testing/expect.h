// Expectations of a decision, with a text that explains a mismatch. No test framework is needed; with one:
//
//   EXPECT_EQ(mismatch(bench.decide(), flies_to_frontier(3)), "");
#pragma once
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <karst/types.h>

namespace karst::testing {

inline std::string describe(const Vec3& v) {
  std::ostringstream out;
  out << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return out.str();
}
inline std::string describe(const Goal& g) {
  std::ostringstream out;
  out << describe(g.position) << ", frontier " << g.frontier_id << ", score " << g.score << ": " << g.why;
  return out.str();
}
/// The whole decision, with one line for each goal.
inline std::string describe(const Decision& d) {
  const char* names[] = {"no outcome", "goals", "hold", "explored", "go home"};
  std::string out = d.outcome <= 4 ? names[d.outcome] : "outcome " + std::to_string(d.outcome);
  if (d.in_order) out += ", in order";
  if (!d.reason.empty()) out += ": " + d.reason;
  for (std::size_t i = 0; i < d.goals.size(); ++i)
    out += "\n  " + std::to_string(i + 1) + ". " + describe(d.goals[i]);
  return out;
}

struct Expectation {
  std::string what;  // "flies to frontier 3 first"
  std::function<bool(const Decision&)> holds;
};

/// "" if the expectation holds, otherwise what was expected and the actual decision.
inline std::string mismatch(const Decision& d, const Expectation& e) {
  return e.holds(d) ? "" : "expected: " + e.what + "\ngot: " + describe(d);
}

inline Expectation flies_to_frontier(std::uint32_t id) {
  return {"flies to frontier " + std::to_string(id) + " first", [id](const Decision& d) {
            return d.outcome == KARST_OUTCOME_GOALS && !d.goals.empty() && d.goals[0].frontier_id == id;
          }};
}
inline Expectation flies_to(const Vec3& place, double within_m = 0.5) {
  return {"flies first to within " + std::to_string(within_m) + " m of " + describe(place),
          [place, within_m](const Decision& d) {
            return d.outcome == KARST_OUTCOME_GOALS && !d.goals.empty() &&
                   distance(d.goals[0].position, place) <= within_m;
          }};
}
/// The decision's goals are these frontiers, in this order, and no others.
inline Expectation offers_frontiers(const std::vector<std::uint32_t>& ids) {
  std::string what = "offers frontiers";
  for (const std::uint32_t id : ids) what += " " + std::to_string(id);
  return {what + " in this order", [ids](const Decision& d) {
            std::vector<std::uint32_t> offered;
            for (const Goal& g : d.goals) offered.push_back(g.frontier_id);
            return d.outcome == KARST_OUTCOME_GOALS && offered == ids;
          }};
}
inline Expectation avoids_frontier(std::uint32_t id) {
  return {"does not offer frontier " + std::to_string(id), [id](const Decision& d) {
            for (const Goal& g : d.goals)
              if (g.frontier_id == id) return false;
            return true;
          }};
}
inline Expectation has_outcome(karst_outcome_t outcome, const std::string& what) {
  return {what, [outcome](const Decision& d) { return d.outcome == outcome && d.goals.empty(); }};
}
inline Expectation holds() { return has_outcome(KARST_OUTCOME_HOLD, "holds"); }
inline Expectation has_explored() { return has_outcome(KARST_OUTCOME_EXPLORED, "says that all is explored"); }
inline Expectation goes_home() { return has_outcome(KARST_OUTCOME_GO_HOME, "goes home"); }
inline Expectation gives_reason(const std::string& part) {
  return {"gives a reason with \"" + part + "\" in it", [part](const Decision& d) {
            const std::string& text = d.goals.empty() ? d.reason : d.goals[0].why;
            return text.find(part) != std::string::npos;
          }};
}
/// The host would accept it: finite numbers, at most 64 goals, reasons of at most 240 bytes.
inline Expectation is_well_formed() {
  return {"is well formed", [](const Decision& d) {
            if (d.goals.size() > 64 || (d.outcome == KARST_OUTCOME_GOALS && d.goals.empty())) return false;
            for (const Goal& g : d.goals)
              if (!is_finite(g.position) || std::isinf(g.heading_rad) || !(g.tolerance_m > 0) ||
                  !std::isfinite(g.tolerance_m) || !(g.max_speed_mps == 0 || g.max_speed_mps >= 0.05) ||
                  !std::isfinite(g.max_speed_mps) || !std::isfinite(g.score) || g.why.size() > 240)
                return false;
            return d.reason.size() <= 240;
          }};
}
inline Expectation operator&&(const Expectation& a, const Expectation& b) {
  return {a.what + ", and " + b.what, [a, b](const Decision& d) { return a.holds(d) && b.holds(d); }};
}

}  // namespace karst::testing
