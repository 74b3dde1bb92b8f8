#include "core_stack/team/team_node.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace karst::core {
namespace {

constexpr double kGoodQuality = 0.2;  // minimal quality of a link for landing: gossip copes with losses
/// Minimal quality of a dropped node's links, each way. The link could not be tested before the drop, and a
/// link at the limit of range is intermittent.
constexpr double kNodeQuality = 0.45;
constexpr double kAntenna_m = 0.3;  // above the ground, of a landed robot
constexpr TimeNs kReceiptPeriod = 2 * kSecond;
constexpr double kHeardNow = 1.0 / 3;  // of link_age: a node received this recently is alive
constexpr double kNear_m = 20.0;       // to an airborne vehicle: states are sent more often

/// In a chain of many radios, states from the far end are older than link_age (gossip.h).
RelayOptions for_chain_of_all(const HomingOptions& homing, const TeamOptions& team) {
  RelayOptions out = homing.relay;
  const auto radios = static_cast<std::size_t>(1 + team.robots * (1 + team.nodes));
  if (radios > kFewRadios + 1)
    out.link_age_s =
        std::max(out.link_age_s, kPeriodsPerRadio * homing.gossip.period_s * static_cast<double>(radios));
  return out;
}

}  // namespace

TeamNode::TeamNode(RobotId self, const TeamOptions& team, const HomingOptions& homing, const Vec3& base,
                   std::uint64_t seed, const MissionKey& key)
    : team_(team),
      link_age_s_(homing.relay.link_age_s),
      landing_separation_m_(homing.landing.separation_m),
      base_{kBase, base, base},
      gossip_({self, static_cast<RobotId>(team.robots), static_cast<RobotId>(team.nodes), key}, homing.gossip,
              seed),
      graph_(for_chain_of_all(homing, team)) {
  TeamState waiting;
  waiting.position = base;
  gossip_.set_state(waiting);
}

void TeamNode::receive(std::span<const std::uint8_t> bytes, TimeNs now) {
  gossip_.receive(bytes, now);
  for (const Delivery& d : gossip_.take_delivered()) take(d);
  for (const TeamState& s : gossip_.states()) graph_.note(s);
}

std::vector<Bytes> TeamNode::transmit(TimeNs now) {
  watch_relays(now);
  if (self() == kBase && news_for_receipt_ && now >= receipt_due_) {
    gossip_.publish(gossip_.receipt());
    news_for_receipt_ = false;
    receipt_due_ = now + kReceiptPeriod;
  }
  TeamState own = gossip_.reported_state();
  own.stamp = now;
  gossip_.set_state(own);
  const std::vector<Neighbour> others = in_the_air(own.phase) ? neighbours(now) : std::vector<Neighbour>{};
  gossip_.hurry(std::any_of(others.begin(), others.end(), [&](const Neighbour& o) {
    return (o.position - own.position).norm() < kNear_m;
  }));
  std::vector<Bytes> frames = gossip_.send(now);
  own.robot = self();
  own.heard = gossip_.contacts(now, 0);
  graph_.note(own);
  return frames;
}

std::uint32_t TeamNode::publish(const Record& record) {
  const std::uint32_t number = gossip_.publish(record);
  take({self(), 0, record});
  return number;
}

void TeamNode::take(const Delivery& d) {
  const auto newer = [](const auto& known, const auto& state) {
    return !known || state.stamp > known->stamp;
  };
  if (const auto* facts = std::get_if<TreeFacts>(&d.record)) {
    note_facts(*facts);
    if (d.author != self() || self() == kBase) {  // a robot's tree holds its own facts; the base creates none
      facts_.nodes.insert(facts_.nodes.end(), facts->nodes.begin(), facts->nodes.end());
      facts_.rays.insert(facts_.rays.end(), facts->rays.begin(), facts->rays.end());
      facts_.lives.insert(facts_.lives.end(), facts->lives.begin(), facts->lives.end());
    }
  } else if (const auto* goal = std::get_if<GoalClaim>(&d.record)) {
    if (newer(goals_[d.author], *goal)) goals_[d.author] = *goal;
  } else if (const auto* landing = std::get_if<LandingClaim>(&d.record)) {
    if (newer(landings_[d.author], *landing)) landings_[d.author] = *landing;
  } else if (const auto* object = std::get_if<ObjectSeen>(&d.record)) {
    note(objects_, d.author, *object);
  }
  if (!std::holds_alternative<Receipt>(d.record)) news_for_receipt_ = true;
}

void TeamNode::note_facts(const TreeFacts& facts) {
  for (const TreeNode& n : facts.nodes)
    if (n.kind == NodeKind::communication && n.id.robot < kMaxRobots) nodes_[n.id.robot] = n.id;
  for (const LifeFact& life : facts.lives) {
    if (life.id.robot >= kMaxRobots) continue;
    auto& known = lives_[life.id.robot];
    if (!known || life.stamp > known->stamp || (life.stamp == known->stamp && !life.alive)) known = life;
  }
}

/// A landed node reports once that a landed neighbour has fallen silent, since others may still hear it. A
/// node that hears a neighbour reported dead reports that it is alive, every time.
void TeamNode::watch_relays(TimeNs now) {
  const auto stands = [this](RobotId r) {
    return r == kBase || (landings_[r] && landings_[r]->state == LandingClaim::State::landed);
  };
  if (!stands(self())) return;
  for (const RadioContact& h : gossip_.contacts(now, 0))
    if (stands(h.robot) && h.quality >= kGoodQuality) heard_at_[h.robot] = now;
  for (RobotId r = 1; r < kMaxRobots; ++r) {
    if (r == self() || !heard_at_[r] || !nodes_[r]) continue;
    const double silent_s = seconds(now - *heard_at_[r]);
    const bool silent = silent_s > link_age_s_, fell_silent = silent && !silent_[r];
    silent_[r] = silent;
    const bool dead = fell_silent && !reported_dead(r);
    const bool alive = silent_s < kHeardNow * link_age_s_ && reported_dead(r);
    if (!dead && !alive) continue;
    TreeFacts state;
    state.lives = {{*nodes_[r], alive, to_milliseconds(now)}};
    publish(state);
  }
}

RelayGraph::Robots TeamNode::landed() const {
  RelayGraph::Robots out{};
  for (RobotId r = 1; r < kMaxRobots; ++r)
    out[r] = landings_[r] && landings_[r]->state == LandingClaim::State::landed;
  return out;
}

/// The nodes with a route to the base over landed nodes only: an airborne robot forwards frames, but flies
/// away. Each node's last known links count, until newer reports contradict them. Reports arrive piecemeal,
/// and a robot that was counted on during its descent must not be dropped for that. A node therefore also
/// counts if its landing is known but no state since, or if it reports contact with a node that counts, even
/// if the links from there to the base are known only as of another time.
RelayGraph::Robots TeamNode::landed_in_range() const {
  const std::vector<TeamState> states = gossip_.states();
  const RelayGraph::Robots landed = this->landed();
  RelayGraph::Robots stands{}, counts{};
  for (const TeamState& state : states) stands[state.robot] = state.phase == TeamPhase::relay;
  const auto may = [&](RobotId r) {  // its state says it landed; the record of that will follow
    if (r == self() || r == kBase || !landings_[r] || reported_dead(r)) return false;
    return landed[r] || (landings_[r]->state == LandingClaim::State::claimed && stands[r]);
  };
  counts[kBase] = true;
  for (RobotId r = 1; r < kMaxRobots; ++r) {
    if (!may(r)) continue;
    const std::optional<TimeNs> heard = graph_.last_heard_of(r);
    counts[r] = r > team_.robots
                    ? heard && graph_.reaches_base(*heard, r, landed, kNodeQuality)
                    : !heard || *heard < landings_[r]->stamp || graph_.reaches_base(*heard, r, landed);
  }
  for (bool more = true; more;) {
    more = false;
    for (const TeamState& state : states)
      if (may(state.robot) && !counts[state.robot])
        more |= counts[state.robot] =
            std::any_of(state.heard.begin(), state.heard.end(), [&](const RadioContact& h) {
              return h.robot < kMaxRobots && counts[h.robot] &&
                     h.quality >= (state.robot > team_.robots ? kNodeQuality : kGoodQuality);
            });
  }
  return counts;
}

std::vector<Relay> TeamNode::relays() const {
  std::vector<Relay> out{base_};
  const RelayGraph::Robots counts = landed_in_range();
  for (RobotId r = 1; r < kMaxRobots; ++r)
    if (counts[r]) out.push_back({r, landings_[r]->ground + Vec3(0, 0, kAntenna_m), landings_[r]->hover});
  for (const TeamState& s : gossip_.states()) {
    const auto& claim = landings_[s.robot];
    if (s.robot == self() || s.robot == kBase || !in_the_air(s.phase) || !claim ||
        claim->state != LandingClaim::State::claimed)
      continue;
    out.push_back({s.robot, claim->ground + Vec3(0, 0, kAntenna_m), claim->hover,
                   s.stamp + from_seconds(s.seconds_left)});
  }
  return out;
}

bool TeamNode::base_in_contact(TimeNs now, TimeNs since) const {
  const RelayGraph::Robots landed = this->landed(), counts = landed_in_range();
  for (const RadioContact& h : gossip_.contacts(now, since))
    if (h.quality >= kGoodQuality &&
        (counts[h.robot] || (landed[h.robot] && graph_.reaches_base(now, h.robot, landed))))
      return true;
  return false;
}

std::vector<Neighbour> TeamNode::neighbours(TimeNs now, TimeNs oldest) const {
  std::vector<Neighbour> out;
  for (const TeamState& s : gossip_.states()) {
    if (s.robot == kBase || s.robot == self() || now - s.stamp > oldest || !in_the_air(s.phase)) continue;
    const double age_s = std::max(0.0, seconds(now - s.stamp));
    out.push_back({s.robot, s.position + age_s * s.velocity_mps, s.velocity_mps, s.phase, age_s});
  }
  return out;
}

bool TeamNode::may_meet_unheard(TimeNs now) const {
  const std::vector<TeamState> states = gossip_.states();
  for (RobotId r = 1; r <= team_.robots; ++r) {
    if (r == self()) continue;
    const auto state =
        std::find_if(states.begin(), states.end(), [r](const TeamState& s) { return s.robot == r; });
    const bool waits =
        state != states.end() && !in_the_air(state->phase) && state->phase != TeamPhase::standby;
    if (!waits && (state == states.end() || now - state->stamp > kNewsHold)) return true;
  }
  return false;
}

std::vector<TeammateState> TeamNode::teammates(TimeNs now) const {
  std::vector<TeammateState> out;
  for (const TeamState& s : gossip_.states()) {
    if (s.robot == kBase || s.robot == self() || s.robot > team_.robots || s.phase == TeamPhase::standby)
      continue;
    const bool explores =
        s.phase == TeamPhase::explore || s.phase == TeamPhase::aside || s.phase == TeamPhase::boxed;
    out.push_back({s.robot, s.stamp, s.position, s.velocity_mps, std::nullopt, explores,
                   std::max(0.0, s.seconds_left)});
    if (explores && claims_goal(s.robot, now)) out.back().goal = goals_[s.robot]->position;
  }
  return out;
}

bool TeamNode::claims_goal(RobotId robot, TimeNs now) const {
  const auto& goal = goals_[robot];
  return goal && !goal->given_up && now - goal->stamp < from_seconds(team_.claim_age_s);
}

std::vector<Vec3> TeamNode::claimed_goals(TimeNs now) const {
  std::vector<Vec3> out;
  for (RobotId r = 1; r < kMaxRobots; ++r)
    if (r != self() && claims_goal(r, now)) out.push_back(goals_[r]->position);
  return out;
}

std::vector<Vec3> TeamNode::taken_ground() const {
  std::vector<Vec3> out;
  for (RobotId r = 1; r < kMaxRobots; ++r)
    if (r != self() && landings_[r] && landings_[r]->state != LandingClaim::State::given_up)
      out.push_back(landings_[r]->ground);
  return out;
}

bool TeamNode::overruled() const {
  const auto& own = landings_[self()];
  if (!own || own->state != LandingClaim::State::claimed) return false;
  for (RobotId r = 1; r < kMaxRobots; ++r) {
    const auto& other = landings_[r];
    if (r == self() || !other || other->state == LandingClaim::State::given_up) continue;
    const bool first = other->state == LandingClaim::State::landed ||
                       std::tuple(other->stamp, r) < std::tuple(own->stamp, self());
    if (first && (other->ground - own->ground).norm() < landing_separation_m_) return true;
  }
  return false;
}

TreeFacts TeamNode::take_facts() { return std::exchange(facts_, {}); }

}  // namespace karst::core
