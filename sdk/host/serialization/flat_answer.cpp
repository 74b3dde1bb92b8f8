#include "sdk/host/serialization/flat_answer.h"

#include <algorithm>
#include <boost/property_tree/info_parser.hpp>
#include <cmath>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/info_reader.h"
#include "sdk/abi/karst_abi_services.h"
#include "sdk/host/boundary/decision_box.h"
#include "sdk/host/boundary/policy_state.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/services/snapshot.h"

namespace karst::host {
namespace {

using core::Vec3;

constexpr std::uint64_t kLongestText = 64 * 1024;
// Limits of a session between two decisions (session.cpp, services.cpp), plus room for the host's own notes.
constexpr std::uint64_t kMaxLogLines = 400, kMaxDrawings = 1000, kMaxDrawnPoints = 400'000;

std::string line(FlatReader& in, std::uint64_t limit) {
  return cleaned(view_of(in.text(kLongestText)), limit);
}

void put(FlatWriter& out, const boost::property_tree::ptree& tree) {
  std::ostringstream text;
  boost::property_tree::write_info(text, tree);
  out.put(text.str());
}

boost::property_tree::ptree tree(FlatReader& in) {
  try {
    return core::parse_info(in.text(kLongestText), "parameters");
  } catch (const core::InputError& e) {
    in.fail(e.what());
  }
}

void put(FlatWriter& out, const PolicyLegacy& l) {
  out.put(l.numbers_drawn);
  out.put(l.state.has_value());
  if (!l.state) return;
  out.put<std::uint64_t>(l.state->size());
  out.put_raw(l.state->data(), l.state->size());
}

PolicyLegacy legacy(FlatReader& in) {
  PolicyLegacy l;
  l.numbers_drawn = in.number<std::uint64_t>();
  if (!in.flag()) return l;
  const std::span<const std::byte> state = in.raw(in.count(1, kMaxStateBytes, "bytes of state"));
  l.state.emplace(state.begin(), state.end());
  return l;
}

void put(FlatWriter& out, const core::Goal& g) {
  out.put(g.position);
  out.put(g.heading_rad);
  out.put(g.tolerance_m);
  out.put(g.max_speed_mps);
  out.put(g.frontier_id);
  out.put(g.score);
  out.put(g.why);
}

core::Goal goal(FlatReader& in) {
  core::Goal g;
  g.position = in.vec3();
  g.heading_rad = in.number<double>();
  g.tolerance_m = in.number<double>();
  g.max_speed_mps = in.number<double>();
  g.frontier_id = in.number<std::uint32_t>();
  g.score = in.number<double>();
  g.why = line(in, kLineLimit);
  return g;
}

/// The same checks as those of the sink in process.
core::Goal sound_goal(FlatReader& in) {
  core::Goal g = goal(in);
  const std::string fault = goal_fault({to_abi(g.position), g.heading_rad, g.tolerance_m, g.max_speed_mps,
                                        g.frontier_id, 0, g.score, view_of(g.why)});
  if (!fault.empty()) in.fail("a goal that is none: " + fault);
  return g;
}

core::Drawing drawing(FlatReader& in, std::uint64_t& points_left) {
  core::Drawing d;
  d.kind = static_cast<core::Drawing::Kind>(
      in.choice(0, static_cast<std::uint32_t>(core::Drawing::Kind::text), "a drawing's kind"));
  d.rgb = in.choice(0, 0xffffff, "a colour");
  d.text = line(in, kLineLimit);
  d.points.resize(in.count(sizeof(double) * 3, points_left, "drawn points"));
  points_left -= d.points.size();
  for (Vec3& p : d.points) {
    p = in.vec3();
    if (!p.allFinite()) in.fail("a drawn point is not finite");
  }
  return d;
}

}  // namespace

Bytes flatten(const StartOrder& o) {
  FlatWriter out;
  out.put(o.file);
  out.put(o.policy);
  out.put(o.source);
  put(out, o.parameters);
  out.put(o.seed);
  out.put(o.failures_allowed);
  out.put(o.memory_limit_bytes);
  put(out, o.legacy);
  return out.take();
}

StartOrder read_start_order(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  StartOrder o;
  o.file = in.text(kLongestText);
  o.policy = in.text(kLongestText);
  o.source = in.text(kLongestText);
  o.parameters = tree(in);
  o.seed = in.number<std::uint64_t>();
  o.failures_allowed = in.number<int>();
  o.memory_limit_bytes = in.number<std::uint64_t>();
  o.legacy = legacy(in);
  in.require_end();
  return o;
}

Bytes flatten(const ReadyReport& r) {
  FlatWriter out;
  out.put(r.version);
  put(out, r.parameters);
  return out.take();
}

ReadyReport read_ready_report(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  ReadyReport r;
  r.version = line(in, kLineLimit);
  r.parameters = tree(in);
  in.require_end();
  return r;
}

Bytes flatten(const DecisionReport& r) {
  FlatWriter out;
  const core::Decision& d = r.decision;
  out.put(static_cast<std::uint32_t>(d.outcome));
  out.put(d.reason);
  out.put<std::uint64_t>(d.goals.size());
  for (const core::Goal& g : d.goals) put(out, g);
  out.put<std::uint64_t>(d.drawings.size());
  for (const core::Drawing& w : d.drawings) {
    out.put(static_cast<std::uint32_t>(w.kind));
    out.put(w.rgb);
    out.put(w.text);
    out.put<std::uint64_t>(w.points.size());
    for (const Vec3& p : w.points) out.put(p);
  }
  out.put<std::uint64_t>(d.log.size());
  for (const std::string& l : d.log) out.put(l);
  put(out, r.legacy);
  return out.take();
}

DecisionReport read_decision_report(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  DecisionReport r;
  core::Decision& d = r.decision;
  d.outcome = static_cast<core::Outcome>(
      in.choice(0, static_cast<std::uint32_t>(core::Outcome::go_home), "the outcome"));
  d.reason = line(in, kLogLineLimit);  // a failure's reason is longer than a policy's own
  const std::size_t goals = in.count(60, kMaxGoals, "goals");
  if ((d.outcome == core::Outcome::goals) != (goals > 0)) in.fail("its goals do not fit the outcome");
  for (std::size_t i = 0; i < goals; ++i) d.goals.push_back(sound_goal(in));
  const std::size_t drawings = in.count(24, kMaxDrawings, "drawings");
  std::uint64_t points_left = kMaxDrawnPoints;
  for (std::size_t i = 0; i < drawings; ++i) d.drawings.push_back(drawing(in, points_left));
  const std::size_t lines = in.count(8, kMaxLogLines, "lines of log");
  for (std::size_t i = 0; i < lines; ++i) d.log.push_back(line(in, 2 * kLogLineLimit));
  r.legacy = legacy(in);
  in.require_end();
  return r;
}

Bytes flatten(const core::PolicyEvent& e) {
  FlatWriter out;
  out.put(static_cast<std::uint32_t>(e.kind));
  out.put(e.stamp);
  put(out, e.goal);
  out.put(e.reason);
  return out.take();
}

core::PolicyEvent read_event(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  core::PolicyEvent e{};
  e.kind = static_cast<core::PolicyEvent::Kind>(
      in.choice(0, static_cast<std::uint32_t>(core::PolicyEvent::Kind::homing), "the event's kind"));
  e.stamp = in.number<core::TimeNs>();
  e.goal = goal(in);
  e.reason = in.text(kLongestText);
  in.require_end();
  return e;
}

Bytes flatten(const LengthsQuestion& q) {
  FlatWriter out;
  out.put(q.from);
  out.put(q.tolerance_m);
  out.put<std::uint64_t>(q.goals.size());
  for (const Vec3& g : q.goals) out.put(g);
  return out.take();
}

LengthsQuestion read_lengths_question(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  LengthsQuestion q;
  q.from = in.vec3();
  q.tolerance_m = in.number<double>();
  q.goals.resize(in.count(sizeof(double) * 3, KARST_MAX_PATH_GOALS, "goals"));
  for (Vec3& g : q.goals) g = in.vec3();
  in.require_end();
  const bool finite = q.from.allFinite() && std::all_of(q.goals.begin(), q.goals.end(),
                                                        [](const Vec3& g) { return g.allFinite(); });
  if (!finite || !(q.tolerance_m >= 0 && q.tolerance_m <= 100)) in.fail("a path between no places");
  return q;
}

Bytes flatten(const PathAnswer& answer) {
  FlatWriter out;
  out.put(static_cast<std::uint32_t>(answer.status));
  out.put<std::uint64_t>(answer.lengths_m.size());
  for (const double l : answer.lengths_m) out.put(l);
  return out.take();
}

PathAnswer read_path_answer(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  PathAnswer answer;
  answer.status = static_cast<PathAnswer::Status>(
      in.choice(0, static_cast<std::uint32_t>(PathAnswer::Status::too_much), "an answer about paths"));
  answer.lengths_m.resize(in.count(sizeof(double), KARST_MAX_PATH_GOALS, "lengths"));
  for (double& l : answer.lengths_m) l = in.number<double>();
  in.require_end();
  return answer;
}

Bytes flatten(const PathsAnswer& answer) {
  FlatWriter out;
  out.put(static_cast<std::uint32_t>(answer.status));
  out.put<std::uint64_t>(answer.paths.size());
  for (const FoundPath& path : answer.paths) {
    out.put(path.length_m);
    out.put(path.clearance_m);
    out.put<std::uint64_t>(path.points.size());
    for (const Vec3& p : path.points) out.put(p);
  }
  return out.take();
}

PathsAnswer read_paths_answer(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  PathsAnswer answer;
  answer.status = static_cast<PathAnswer::Status>(
      in.choice(0, static_cast<std::uint32_t>(PathAnswer::Status::too_much), "an answer about paths"));
  answer.paths.resize(in.count(24, KARST_MAX_PATHS, "paths"));
  std::uint64_t points_left = KARST_MAX_PATH_POINTS;
  for (FoundPath& path : answer.paths) {
    path.length_m = in.number<double>();
    path.clearance_m = in.number<double>();
    path.points.resize(in.count(sizeof(double) * 3, points_left, "points of paths"));
    points_left -= path.points.size();
    for (Vec3& p : path.points) p = in.vec3();
  }
  in.require_end();
  return answer;
}

Bytes flatten(const std::string& text) {
  FlatWriter out;
  out.put(text);
  return out.take();
}

std::string read_text(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  std::string text = line(in, kLongestText);
  in.require_end();
  return text;
}

}  // namespace karst::host
