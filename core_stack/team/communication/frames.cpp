// Frames: single radio transmissions.
#include <algorithm>

#include "core_stack/team/communication/message_parts.h"

namespace karst::core {
namespace {

constexpr std::uint16_t kMark = 0x724b;  // "Kr"
constexpr double kMaxSpeed_cmps = 10000;

void write(PartWriter& w, const TeamState& s) {
  w.robot(s.robot);
  w.time(s.stamp);
  w.place(s.position);
  for (int i = 0; i < 3; ++i) w.scaled(s.velocity_mps[i], 0.01, kMaxSpeed_cmps, 2);
  w.byte(static_cast<std::uint8_t>(s.phase));
  if (!(s.seconds_left >= 0)) w.refuse();
  w.scaled(std::min(s.seconds_left, 65535.0), 1, 65535, 2);
  if (s.heard.size() > kMaxRobots) w.refuse();
  w.count(s.heard.size());
  for (const RadioContact& h : s.heard) {
    w.robot(h.robot);
    if (!(h.quality >= 0)) w.refuse();
    w.scaled(h.quality, 1.0 / 255, 255, 1);
  }
}

TeamState read_state(PartReader& r) {
  TeamState s;
  s.robot = r.robot();
  s.stamp = r.time();
  s.position = r.place();
  for (int i = 0; i < 3; ++i) s.velocity_mps[i] = static_cast<double>(r.whole(2)) / 100.0;
  if (s.velocity_mps.cwiseAbs().maxCoeff() > kMaxSpeed_cmps / 100) r.refuse(Refusal::range);
  s.phase = r.one_of<TeamPhase>(9);
  s.seconds_left = static_cast<double>(r.number(2));
  const std::size_t heard = r.count(2);
  if (heard > kMaxRobots) r.refuse(Refusal::range);
  for (std::size_t i = 0; i < heard && r.fine(); ++i) {
    const RobotId robot = r.robot();
    s.heard.push_back({robot, r.byte() / 255.0});
  }
  return s;
}

void write(PartWriter& w, const Held& h) {
  w.robot(h.author);
  w.limited(h.first, kMaxNumber);
  w.compact(h.beyond);
}

void write(PartWriter& w, const SentRecord& r) {
  w.robot(r.author);
  w.limited(r.number, kMaxNumber);
  if (r.number == 0) w.refuse();
  w.count(r.bytes.size());
  for (const std::uint8_t b : r.bytes) w.byte(b);
}

template <class Part>
std::size_t bytes_of(const Part& part) {
  Bytes out;
  PartWriter w(out);
  write(w, part);
  return out.size();
}

}  // namespace

std::size_t state_bytes(const TeamState& s) { return bytes_of(s); }
std::size_t held_bytes(const Held& h) { return bytes_of(h); }
std::size_t record_bytes(const SentRecord& r) { return bytes_of(r); }

std::optional<Bytes> write_frame(const Frame& frame, const MissionKey& key) {
  Bytes out;
  PartWriter w(out);
  w.number(kMark, 2);
  w.byte(kWireVersion);
  w.byte(static_cast<std::uint8_t>(frame.sender | frame.reports_held << 7));
  if (frame.sender >= kMaxRobots) w.refuse();
  w.time(frame.sent);
  w.number(frame.sequence, 2);
  const auto parts = [&w](const auto& list) {
    w.count(list.size());
    for (const auto& part : list) write(w, part);
  };
  parts(frame.states);
  parts(frame.held);
  parts(frame.records);
  if (!w.fine() || out.size() + kTagBytes > kFrameBytes) return std::nullopt;
  const Tag tag = tag_of(out, key);
  out.insert(out.end(), tag.begin(), tag.end());
  return out;
}

std::optional<Frame> read_frame(std::span<const std::uint8_t> bytes, const MissionKey& key, Refusal& why) {
  const auto refuse = [&why](Refusal r) {
    why = r;
    return std::nullopt;
  };
  if (bytes.size() < kEmptyFrameBytes || bytes.size() > kFrameBytes) return refuse(Refusal::too_short);
  const auto said = bytes.first(bytes.size() - kTagBytes);
  PartReader r(said);
  if (r.number(2) != kMark) return refuse(Refusal::no_frame);
  // Checked before the tag, since another version may have another tag.
  if (r.byte() != kWireVersion) return refuse(Refusal::version);
  if (!has_tag(said, bytes.last(kTagBytes), key)) return refuse(Refusal::forged);
  Frame frame;
  const std::uint8_t sender = r.byte();
  frame.reports_held = sender & 0x80;
  frame.sender = sender & 0x7f;
  if (frame.sender >= kMaxRobots) return refuse(Refusal::range);
  frame.sent = r.time();
  frame.sequence = static_cast<std::uint16_t>(r.number(2));
  for (std::size_t n = r.count(24); n > 0 && r.fine(); --n) frame.states.push_back(read_state(r));
  for (std::size_t n = r.count(3); n > 0 && r.fine(); --n) {
    Held h;
    h.author = r.robot();
    h.first = r.limited(kMaxNumber);
    h.beyond = r.compact();
    frame.held.push_back(h);
  }
  for (std::size_t n = r.count(3); n > 0 && r.fine(); --n) {
    SentRecord record;
    record.author = r.robot();
    record.number = r.limited(kMaxNumber);
    if (record.number == 0) r.refuse(Refusal::range);
    const auto body = r.bytes(r.byte());
    record.bytes.assign(body.begin(), body.end());
    frame.records.push_back(std::move(record));
  }
  if (!r.finished()) return refuse(r.why());
  return frame;
}

}  // namespace karst::core
