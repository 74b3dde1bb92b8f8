#include "core_stack/team/communication/gossip.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace karst::core {
namespace {

constexpr double kBurstFrames = 10;
constexpr double kLongestWait_s = 0.4;
constexpr double kHaste = 3;  // rate factor while peers hold different records or another robot is near
constexpr std::size_t kMaxAnswered = 40;  // records queued for a peer that lacks more
constexpr std::size_t kMaxWaiting = 400;
constexpr int kTimesReported = 2;        // broadcasts of each state, or too many are lost along a chain
constexpr TimeNs kSteady = 4 * kSecond;  // in a large team, the period of unchanged states
/// How long after its start a robot accepts from others records that it wrote before a restart.
constexpr TimeNs kReminded = 10 * kSecond;

}  // namespace

void describe(OptionTable& t, GossipOptions& o) {
  t.add("period", o.period_s, "s", 0.1, 60, "every robot tells its state and what it holds so often");
  t.add("bytes_per_second", o.bytes_per_s, "", 50, 1e6, "a robot sends no more than that, as a mean");
  t.add("contact_age", o.contact_age_s, "s", 0.5, 600,
        "a robot not heard for longer is out of contact; a frame sent longer ago is refused");
  t.add("max_records", o.max_records, 100, 1e6, "of one robot; more are refused");
}

Gossip::Gossip(const TeamRadio& radio, const GossipOptions& options, std::uint64_t seed)
    : radio_(radio),
      options_(options),
      random_(Random::stream(seed, "gossip " + std::to_string(radio.self))),
      store_(static_cast<std::uint32_t>(options.max_records)),
      allowance_bytes_(kBurstFrames * kFrameBytes) {
  next_news_ = from_seconds(options_.period_s * random_.uniform());
}

TimeNs Gossip::wait() { return from_seconds(kLongestWait_s * random_.uniform()); }

std::uint32_t Gossip::publish(const Record& record) {
  std::vector<Record> pieces;
  if (const auto* facts = std::get_if<TreeFacts>(&record))
    for (TreeFacts& piece : split(*facts)) pieces.push_back(std::move(piece));
  else
    pieces.push_back(record);
  std::uint32_t last = 0;
  for (const Record& piece : pieces) {
    const auto bytes = write_record(piece);
    if (!bytes) return 0;
    // Numbers follow its own store, whatever others claim that it wrote.
    const std::uint32_t number = store_.held(self()).first() + 1;
    if (store_.take({self(), number, *bytes}) != RecordStore::Taken::fresh) return 0;
    last = number;
    published_ = true;
    queue(self(), last, last_send_);
  }
  return last;
}

bool Gossip::in_contact(const Peer& p, TimeNs now) const {
  return p.heard_at && now - *p.heard_at <= from_seconds(options_.contact_age_s);
}

void Gossip::receive(std::span<const std::uint8_t> bytes, TimeNs now) {
  if (!began_) began_ = now;
  ++counts_.frames_heard;
  counts_.bytes_heard += bytes.size();
  Refusal why{};
  const std::optional<Frame> frame = read_frame(bytes, radio_.key, why);
  if (!frame) {
    ++counts_.refused[static_cast<std::size_t>(why)];
  } else if (frame->sender != self()) {  // its own frame, echoed or forged
    take_frame(*frame, now);
  }
}

/// Checks that the tag does not cover.
std::optional<Refusal> Gossip::refused(const Frame& frame, TimeNs now) const {
  if (!radio_.is_member(frame.sender)) return Refusal::stranger;
  if (frame.sent > now + kClockTolerance || now - frame.sent > from_seconds(options_.contact_age_s))
    return Refusal::stale;
  return std::nullopt;
}

void Gossip::take_frame(const Frame& frame, TimeNs now) {
  std::optional<Refusal> why = refused(frame, now);
  ReplayWindow::Verdict verdict{};
  if (!why) {
    verdict = peers_[frame.sender].replays.take(frame.sent, frame.sequence);
    if (verdict == ReplayWindow::Verdict::refused) why = Refusal::replayed;
  }
  if (why) {
    ++counts_.refused[static_cast<std::size_t>(*why)];
    return;
  }
  const bool newest = verdict == ReplayWindow::Verdict::newest;
  if (newest) take_newest(frame, now);
  for (const TeamState& s : frame.states) take_state(s, now);
  for (const SentRecord& r : frame.records) take_record(r, frame.sender, now);
  if (newest && frame.reports_held) take_held(frame, now);
}

/// Handles the sender's newest frame: it is in contact.
void Gossip::take_newest(const Frame& frame, TimeNs now) {
  Peer& peer = peers_[frame.sender];
  if (in_contact(peer, now)) {
    // A moving average over about ten frames; each gap counts as that many losses.
    constexpr double kFraction = 0.1;
    const auto gap = static_cast<std::int16_t>(frame.sequence - peer.sequence);
    for (int lost = std::min<int>(gap, 20); lost > 1; --lost) peer.quality -= kFraction * peer.quality;
    peer.quality += kFraction * (1 - peer.quality);
  } else {
    peer.quality = 0.5;                         // initial guess
    for (Reported& t : reported_) t.times = 0;  // it has not received earlier broadcasts
  }
  peer.sequence = frame.sequence;
  peer.heard_at = now;
}

void Gossip::take_held(const Frame& frame, TimeNs now) {
  Peer& peer = peers_[frame.sender];
  peer.held.fill({});
  const HeldNumbers& own = store_.held(self());
  for (const Held& h : frame.held) {
    const std::uint64_t highest = std::uint64_t{h.first} + (h.beyond ? 1 + std::bit_width(h.beyond) : 0);
    if (h.author == self() && highest > own.first()) {
      ++counts_.claims_refused;  // claims more than was written: ignore all of it
      continue;
    }
    peer.held[h.author].set(h);
  }
  if (frame.sender == kBase) known_to_hold(peer.held[self()].first());
  answer(frame.sender, now);
}

/// Notes what the base reports to hold; ignores claims beyond the records written.
void Gossip::known_to_hold(std::uint32_t own_records) {
  if (own_records <= store_.held(self()).first())
    known_at_base_ = std::max(known_at_base_, own_records);
  else
    ++counts_.claims_refused;
}

void Gossip::take_state(const TeamState& s, TimeNs now) {
  if (!plausible(radio_, s, now)) {
    ++counts_.states_refused;
    return;
  }
  auto& known = states_[s.robot];
  if (s.robot != self() && (!known || s.stamp > known->stamp)) known = s;
}

/// Shortly after a restart with an empty store, others may return a robot's earlier records, so that it
/// continues their numbering. Later it refuses records of its own that it does not hold.
bool Gossip::may_be_reminded(TimeNs now) const { return !published_ && began_ && now - *began_ <= kReminded; }

void Gossip::take_record(const SentRecord& r, RobotId from, TimeNs now) {
  Refusal why{};
  std::optional<Record> record = read_record(r.bytes, why);
  const bool unheard_of = r.author == self() && !store_.held(self()).holds(r.number) && !may_be_reminded(now);
  if (!record || unheard_of || !plausible(radio_, r.author, *record, now)) {
    ++counts_.records_refused;
    return;
  }
  HeldNumbers& theirs = peers_[from].held[r.author];
  if (theirs.takes(r.number)) theirs.add(r.number);
  switch (store_.take(r)) {
    case RecordStore::Taken::known:
      ++counts_.records_again;
      // It was just sent; a peer that missed it will report that.
      std::erase_if(waiting_,
                    [&r](const Waiting& w) { return w.author == r.author && w.number == r.number; });
      return;
    case RecordStore::Taken::differs:
      ++counts_.contradictions;
      return;
    case RecordStore::Taken::full:
    case RecordStore::Taken::too_far:
      ++counts_.records_refused;
      return;
    case RecordStore::Taken::fresh:
      break;
  }
  ++counts_.records_taken;
  if (const auto* receipt = std::get_if<Receipt>(&*record); receipt && r.author == kBase)
    for (const Receipt::Row& row : receipt->rows)
      if (row.robot == self()) known_to_hold(row.records);
  delivered_.push_back({r.author, r.number, std::move(*record)});
  queue(r.author, r.number, now + wait());
}

/// Queues the records that a peer lacks, oldest first.
void Gossip::answer(RobotId peer, TimeNs now) {
  std::size_t queued = 0;
  const TimeNs due = now + wait();
  for (RobotId author = 0; author < kMaxRobots; ++author) {
    const HeldNumbers &mine = store_.held(author), &theirs = peers_[peer].held[author];
    for (std::uint32_t n = theirs.first() + 1;
         theirs.takes(n) && n <= mine.first() + 1 + HeldNumbers::window && queued < kMaxAnswered; ++n)
      if (mine.holds(n) && !theirs.holds(n)) {
        queue(author, n, due);
        ++queued;
      }
  }
}

void Gossip::queue(RobotId author, std::uint32_t number, TimeNs due) {
  const bool there = std::any_of(waiting_.begin(), waiting_.end(),
                                 [&](const Waiting& w) { return w.author == author && w.number == number; });
  if (!there && waiting_.size() < kMaxWaiting) waiting_.push_back({due, author, number});
}

/// Whether a peer in contact may lack the record and would accept it.
bool Gossip::wanted(const Waiting& w, TimeNs now) const {
  return std::any_of(peers_.begin(), peers_.end(), [&](const Peer& p) {
    const HeldNumbers& theirs = p.held[w.author];
    return in_contact(p, now) && !theirs.holds(w.number) && theirs.takes(w.number);
  });
}

/// Whether a peer in contact is known to hold other records than this robot.
bool Gossip::unsettled(TimeNs now) const {
  for (const Peer& p : peers_)
    for (RobotId a = 0; in_contact(p, now) && a < kMaxRobots; ++a)
      if (!(p.held[a] == store_.held(a))) return true;
  return false;
}

std::vector<Bytes> Gossip::send(TimeNs now) {
  if (!began_) began_ = now;
  allowance_bytes_ = std::min(allowance_bytes_ + options_.bytes_per_s * seconds(now - last_send_),
                              kBurstFrames * kFrameBytes);
  last_send_ = now;
  std::vector<Bytes> out;
  const auto due = [now](const Waiting& w) { return w.due <= now; };
  std::erase_if(waiting_, [&](const Waiting& w) { return due(w) && !wanted(w, now); });
  while (allowance_bytes_ >= kFrameBytes) {
    const bool news = now >= next_news_;
    if (!news && std::none_of(waiting_.begin(), waiting_.end(), due)) break;
    Frame frame = news ? own_news(now) : Frame{};
    std::size_t room = kFrameBytes - kEmptyFrameBytes;
    for (const TeamState& s : frame.states) room -= state_bytes(s);
    for (const Held& h : frame.held) room -= held_bytes(h);
    std::erase_if(waiting_, [&](const Waiting& w) {
      const SentRecord* r = due(w) ? store_.find(w.author, w.number) : nullptr;
      const std::size_t bytes = r ? record_bytes(*r) : 0;
      if (r == nullptr || bytes > room) return false;
      frame.records.push_back(*r);
      room -= bytes;
      return true;
    });
    const std::size_t passed = news ? add_states(frame, room) : 0;
    finish(frame, now, out);
    if (news) report_more_states(passed, now, out);
  }
  return out;
}

bool Gossip::of_many() const {
  const auto known =
      std::count_if(states_.begin(), states_.end(), [](const auto& s) { return s.has_value(); });
  return static_cast<std::size_t>(known) > kFewRadios;
}

/// In a large team few states fit into a robot's own frame, and along a chain they would be old on arrival.
/// Once a period all new states are therefore sent before any records, as far as the allowance permits
/// besides the robot's own state, which must be sent on time, as separation depends on it.
void Gossip::report_more_states(std::size_t passed, TimeNs now, std::vector<Bytes>& out) {
  if (!of_many() || now < all_states_due_) return;
  all_states_due_ = now + from_seconds(0.8 * options_.period_s);  // frames are not exactly periodic
  const double left_bytes = hurried_ ? kHaste * kFrameBytes : -1.0 * kFrameBytes;
  while (passed < kMaxRobots && allowance_bytes_ > left_bytes) {
    Frame frame;
    std::size_t room = kFrameBytes - kEmptyFrameBytes;
    passed += add_states(frame, room);
    if (!frame.states.empty()) finish(frame, now, out);
  }
}

Frame Gossip::own_news(TimeNs now) {
  // Jittered, or two robots that collide once would always do so. While records are outstanding, every
  // version vector speeds up their delivery; in a large team some always are.
  const double period_s = options_.period_s / (hurried_ || (!of_many() && unsettled(now)) ? kHaste : 1);
  next_news_ = now + from_seconds(period_s * random_.uniform(0.9, 1.1));
  Frame frame;
  state_.robot = self();
  state_.heard.clear();
  frame.reports_held = true;
  std::size_t bytes = kEmptyFrameBytes + state_bytes(state_);
  for (RobotId author = 0; author < kMaxRobots; ++author) {
    const Held h = store_.held(author).summary(author);
    if (h.first == 0 && h.beyond == 0) continue;
    frame.held.push_back(h);
    bytes += held_bytes(h);
  }
  state_.heard = contacts(now, 0);
  if (bytes + 2 * state_.heard.size() > kFrameBytes)  // what is held beyond the first one lacking can wait
    for (Held& h : frame.held) {
      bytes -= held_bytes(h);
      h.beyond = 0;
      bytes += held_bytes(h);
    }
  if (const std::size_t room = (kFrameBytes - bytes) / 2; state_.heard.size() > room) {
    std::stable_sort(state_.heard.begin(), state_.heard.end(),
                     [](const RadioContact& a, const RadioContact& b) { return a.quality > b.quality; });
    state_.heard.resize(room);
  }
  frame.states = {state_};
  return frame;
}

/// Adds others' states round-robin as far as there is room; returns how many radios were visited. In a large
/// team only new states are added.
std::size_t Gossip::add_states(Frame& frame, std::size_t& room) {
  const bool many = of_many();
  std::size_t passed = 0;
  for (; passed < kMaxRobots; ++passed) {
    const RobotId i = next_reported_;
    const auto& s = states_[i];
    const TimeNs newer_by = s && in_the_air(s->phase) ? 0 : kSteady;
    const bool is_new = s && (!reported_[i].stamp || s->stamp > *reported_[i].stamp + newer_by);
    if (s && (!many || is_new || reported_[i].times < kTimesReported)) {
      if (state_bytes(*s) > room) break;
      frame.states.push_back(*s);
      room -= state_bytes(*s);
      if (is_new) reported_[i] = {s->stamp, 0};
      ++reported_[i].times;
    }
    next_reported_ = static_cast<RobotId>((next_reported_ + 1) % kMaxRobots);
  }
  return passed;
}

void Gossip::finish(Frame& frame, TimeNs now, std::vector<Bytes>& out) {
  frame.sender = self();
  frame.sent = now;
  frame.sequence = sequence_++;
  std::optional<Bytes> bytes = write_frame(frame, radio_.key);
  if (!bytes && !frame.states.empty()) {
    // Its own state cannot be written (for example, not finite): the rest is sent without it.
    frame.states.clear();
    bytes = write_frame(frame, radio_.key);
  }
  if (!bytes) return;
  ++counts_.frames_sent;
  counts_.bytes_sent += bytes->size();
  allowance_bytes_ -= static_cast<double>(bytes->size());
  out.push_back(std::move(*bytes));
}

std::vector<Delivery> Gossip::take_delivered() { return std::exchange(delivered_, {}); }

Receipt Gossip::receipt() const {
  Receipt out;
  for (RobotId i = 0; i < kMaxRobots; ++i)
    if (store_.held(i).first() > 0) out.rows.push_back({i, store_.held(i).first()});
  return out;
}

std::vector<TeamState> Gossip::states() const {
  std::vector<TeamState> out;
  for (const auto& s : states_)
    if (s) out.push_back(*s);
  return out;
}

std::vector<RadioContact> Gossip::contacts(TimeNs now, TimeNs since) const {
  std::vector<RadioContact> out;
  for (RobotId i = 0; i < kMaxRobots; ++i)
    if (in_contact(peers_[i], now) && *peers_[i].heard_at >= since) out.push_back({i, peers_[i].quality});
  return out;
}

}  // namespace karst::core
