// The facts of the homing tree that robots exchange: nodes, rays between them, and which communication nodes
// are alive. Facts are never revoked, only superseded by later ones, so they may arrive in any order and more
// than once.
#pragma once
#include <cstdint>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::core {

/// Number of a robot in its team; 0 is the base station.
using RobotId = std::uint8_t;
constexpr RobotId kBase = 0;

/// A node's author and sequence number.
struct NodeId {
  RobotId robot = 0;
  std::uint32_t number = 0;
  auto operator<=>(const NodeId&) const = default;
  std::uint64_t name() const { return std::uint64_t{robot} << 32 | number; }
};

enum class NodeKind : std::uint8_t { pose, communication };

/// A position in free air: a robot's past pose, or the hover above its landing site. World frame, rounded to
/// centimetres.
struct TreeNode {
  NodeId id;
  NodeKind kind = NodeKind::pose;
  Vec3 position = Vec3::Zero();
};

/// Whether the straight line between two nodes can be flown, as observed at `stamp`. A later fact supersedes
/// an earlier one; of two at the same time, "not free" wins.
struct RayFact {
  NodeId a, b;
  bool free = false;
  TimeNs stamp = 0;
};

/// Whether a communication node is alive, as known at `stamp`. A later fact supersedes an earlier one; of two
/// at the same time, "dead" wins. A node without a fact is alive.
struct LifeFact {
  NodeId id;
  bool alive = false;
  TimeNs stamp = 0;
};

struct TreeFacts {
  std::vector<TreeNode> nodes;
  std::vector<RayFact> rays;
  std::vector<LifeFact> lives;
  bool empty() const { return nodes.empty() && rays.empty() && lives.empty(); }
};

/// Positions and times rounded as in messages, so that every robot computes with the same numbers.
inline Vec3 to_centimetres(const Vec3& p) { return (p * 100.0).array().round() / 100.0; }
inline TimeNs to_milliseconds(TimeNs t) { return t / kMillisecond * kMillisecond; }

}  // namespace karst::core
