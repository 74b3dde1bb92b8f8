// The fields of messages, each with a range check. Private to team.
#pragma once
#include <cmath>

#include "core_stack/team/communication/messages.h"

namespace karst::core {

class PartWriter : public WireWriter {
 public:
  using WireWriter::WireWriter;

  bool fine() const { return fine_; }
  void refuse() { fine_ = false; }
  void count(std::size_t n) {
    if (n > 255) refuse();
    byte(static_cast<std::uint8_t>(n));
  }
  void robot(RobotId r) {
    if (r >= kMaxRobots) refuse();
    byte(r);
  }
  void limited(std::uint32_t v, std::uint32_t below) {
    if (v >= below) refuse();
    compact(v);
  }
  void node_id(const NodeId& id) {
    robot(id.robot);
    limited(id.number, kMaxNumber);
  }
  /// Milliseconds in four bytes: 49 days.
  void time(TimeNs t) {
    if (t < 0 || t / kMillisecond > 0xffffffffll) refuse();
    number(static_cast<std::uint64_t>(t / kMillisecond), 4);
  }
  void place(const Vec3& p) {
    for (int i = 0; i < 3; ++i) scaled(p[i], 0.01, kMaxCoordinate_m * 100, 3);
  }
  /// Writes v in units of `step`; refuses more than `most` of them in magnitude.
  void scaled(double v, double step, double most, int bytes) {
    const double steps = std::round(v / step);
    if (!(std::abs(steps) <= most)) return refuse();
    number(static_cast<std::uint64_t>(static_cast<std::int64_t>(steps)), bytes);
  }

 private:
  bool fine_ = true;
};

class PartReader : public WireReader {
 public:
  using WireReader::WireReader;

  bool fine() const { return !bad() && !refused_; }
  bool finished() const { return fine() && left() == 0; }
  Refusal why() const { return refused_ ? *refused_ : Refusal::truncated; }
  /// Keeps the first reason, unless a read past the end caused it.
  void refuse(Refusal why) {
    if (fine()) refused_ = why;
  }
  /// Reads a count of parts of at least `min_bytes` each; refuses a count that exceeds the bytes left.
  std::size_t count(std::size_t min_bytes) {
    const std::size_t n = byte();
    if (n * min_bytes <= left()) return n;
    refuse(Refusal::truncated);
    return 0;
  }
  template <class Enum>
  Enum one_of(std::uint8_t below) {
    const std::uint8_t v = byte();
    if (v < below) return static_cast<Enum>(v);
    refuse(Refusal::kind);
    return Enum{};
  }
  bool yes_or_no() {
    const std::uint8_t v = byte();
    if (v > 1) refuse(Refusal::kind);
    return v == 1;
  }
  RobotId robot() {
    const RobotId r = byte();
    if (r < kMaxRobots) return r;
    refuse(Refusal::range);
    return 0;
  }
  std::uint32_t limited(std::uint32_t below) {
    const std::uint32_t v = compact();
    if (v < below) return v;
    refuse(Refusal::range);
    return 0;
  }
  NodeId node_id() {
    const RobotId r = robot();
    return {r, limited(kMaxNumber)};
  }
  TimeNs time() { return static_cast<TimeNs>(number(4)) * kMillisecond; }
  Vec3 place() {
    Vec3 p;
    // Divided, not multiplied by 0.01: the same number as to_centimetres() gives.
    for (int i = 0; i < 3; ++i) p[i] = static_cast<double>(whole(3)) / 100.0;
    if (p.cwiseAbs().maxCoeff() <= kMaxCoordinate_m) return p;
    refuse(Refusal::range);
    return Vec3::Zero();
  }

 private:
  std::optional<Refusal> refused_;
};

}  // namespace karst::core
