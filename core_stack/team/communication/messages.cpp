#include "core_stack/team/communication/messages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core_stack/team/communication/message_parts.h"

namespace karst::core {
namespace {

void write(PartWriter& w, const TreeFacts& facts) {
  w.count(facts.nodes.size());
  w.count(facts.rays.size());
  w.count(facts.lives.size());
  for (const TreeNode& n : facts.nodes) {
    w.node_id(n.id);
    w.byte(static_cast<std::uint8_t>(n.kind));
    w.place(n.position);
  }
  // Most rays of one piece share a node and a time stamp, which are written once.
  const RayFact* before = nullptr;
  for (const RayFact& r : facts.rays) {
    const bool same = before && before->a == r.a && before->stamp == r.stamp;
    w.byte(static_cast<std::uint8_t>((same ? 2 : 0) | (r.free ? 1 : 0)));
    if (!same) {
      w.node_id(r.a);
      w.time(r.stamp);
    }
    w.node_id(r.b);
    before = &r;
  }
  for (const LifeFact& l : facts.lives) {
    w.node_id(l.id);
    w.byte(l.alive);
    w.time(l.stamp);
  }
}

void read(PartReader& r, TreeFacts& facts) {
  const std::size_t nodes = r.count(12), rays = r.count(3), lives = r.count(7);
  for (std::size_t i = 0; i < nodes && r.fine(); ++i) {
    const NodeId id = r.node_id();
    const auto kind = r.one_of<NodeKind>(2);
    facts.nodes.push_back({id, kind, r.place()});
  }
  for (std::size_t i = 0; i < rays && r.fine(); ++i) {
    const std::uint8_t flags = r.byte();
    RayFact ray;
    if (flags > 3 || (flags & 2 && i == 0)) r.refuse(Refusal::kind);
    if (flags & 2 && i > 0) {
      ray.a = facts.rays.back().a;
      ray.stamp = facts.rays.back().stamp;
    } else {
      ray.a = r.node_id();
      ray.stamp = r.time();
    }
    ray.b = r.node_id();
    ray.free = flags & 1;
    if (ray.a == ray.b) r.refuse(Refusal::range);
    facts.rays.push_back(ray);
  }
  for (std::size_t i = 0; i < lives && r.fine(); ++i) {
    const NodeId id = r.node_id();
    const bool alive = r.yes_or_no();
    facts.lives.push_back({id, alive, r.time()});
  }
}

void write(PartWriter& w, const GoalClaim& g) {
  w.time(g.stamp);
  w.place(g.position);
  w.byte(g.given_up);
}
void write(PartWriter& w, const LandingClaim& l) {
  w.time(l.stamp);
  w.place(l.ground);
  w.place(l.hover);
  w.byte(static_cast<std::uint8_t>(l.state));
}
void write(PartWriter& w, const ObjectSeen& o) {
  w.time(o.stamp);
  w.limited(o.object, kMaxNumber);
  w.byte(o.kind);
  w.place(o.position);
  w.scaled(o.deviation_m, 0.1, 255, 1);
}
void write(PartWriter& w, const Receipt& receipt) {
  if (receipt.rows.size() > kMaxRobots) w.refuse();
  w.count(receipt.rows.size());
  for (const Receipt::Row& row : receipt.rows) {
    w.robot(row.robot);
    w.limited(row.records, kMaxNumber);
  }
}

void read(PartReader& r, GoalClaim& goal) {
  goal.stamp = r.time();
  goal.position = r.place();
  goal.given_up = r.yes_or_no();
}

void read(PartReader& r, LandingClaim& landing) {
  landing.stamp = r.time();
  landing.ground = r.place();
  landing.hover = r.place();
  landing.state = r.one_of<LandingClaim::State>(3);
}

void read(PartReader& r, ObjectSeen& seen) {
  seen.stamp = r.time();
  seen.object = r.limited(kMaxNumber);
  seen.kind = r.byte();
  seen.position = r.place();
  seen.deviation_m = 0.1 * r.byte();
}

void read(PartReader& r, Receipt& receipt) {
  const std::size_t rows = r.count(2);
  if (rows > kMaxRobots) r.refuse(Refusal::range);
  for (std::size_t i = 0; i < rows && r.fine(); ++i) {
    const RobotId robot = r.robot();
    receipt.rows.push_back({robot, r.limited(kMaxNumber)});
  }
}

/// A record's kind is its type's index in the variant.
template <std::size_t kind = 0>
Record read_body(std::size_t wanted, PartReader& r) {
  if constexpr (kind + 1 < std::variant_size_v<Record>)
    if (wanted != kind) return read_body<kind + 1>(wanted, r);
  std::variant_alternative_t<kind, Record> record;
  read(r, record);
  return record;
}

}  // namespace

std::optional<Bytes> write_record(const Record& record) {
  Bytes out;
  PartWriter w(out);
  w.byte(static_cast<std::uint8_t>(record.index()));
  std::visit([&w](const auto& r) { write(w, r); }, record);
  if (!w.fine() || out.size() > max_record_bytes()) return std::nullopt;
  return out;
}

std::optional<Record> read_record(std::span<const std::uint8_t> bytes, Refusal& why) {
  PartReader r(bytes);
  if (bytes.size() > max_record_bytes()) r.refuse(Refusal::range);
  const std::uint8_t kind = r.byte();
  if (kind >= std::variant_size_v<Record>) r.refuse(Refusal::kind);
  if (r.fine()) {
    Record record = read_body(kind, r);
    if (r.finished()) return record;
  }
  why = r.why();
  return std::nullopt;
}

std::vector<TreeFacts> split(const TreeFacts& facts) {
  std::vector<TreeFacts> pieces;
  TreeFacts piece;
  const auto add = [&](auto member, const auto& fact) {
    TreeFacts alone;
    (alone.*member).push_back(fact);
    if (!write_record(alone)) return;
    (piece.*member).push_back(fact);
    if (write_record(piece)) return;
    (piece.*member).pop_back();
    pieces.push_back(std::exchange(piece, alone));
  };
  for (const TreeNode& n : facts.nodes) add(&TreeFacts::nodes, n);
  for (const RayFact& r : facts.rays) add(&TreeFacts::rays, r);
  for (const LifeFact& l : facts.lives) add(&TreeFacts::lives, l);
  if (!piece.empty()) pieces.push_back(std::move(piece));
  return pieces;
}

}  // namespace karst::core
