// What robots tell one another of the homing tree: nodes, rays between them, and which communication nodes
// live. Facts are never taken back, only overruled by later ones, so they may arrive in any order and more
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

/// Who made a node, and its how many-th it was.
struct NodeId {
  RobotId robot = 0;
  std::uint32_t number = 0;
  auto operator<=>(const NodeId&) const = default;
  std::uint64_t name() const { return std::uint64_t{robot} << 32 | number; }
};

enum class NodeKind : std::uint8_t { pose, communication };

/// A place in free air: where a robot was, or hovered above where it landed. World frame, whole centimetres.
struct TreeNode {
  NodeId id;
  NodeKind kind = NodeKind::pose;
  Vec3 position = Vec3::Zero();
};

/// The straight line between two nodes can be flown, or not, as seen at `stamp`. Of two facts the later
/// holds; of two at one time the one that says no.
struct RayFact {
  NodeId a, b;
  bool free = false;
  TimeNs stamp = 0;
};

/// A communication node answers, or not, as known at `stamp`; the later holds, and no before yes. Without any
/// it does.
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

/// Positions and times as messages carry them: every robot computes with the same numbers.
inline Vec3 to_centimetres(const Vec3& p) { return (p * 100.0).array().round() / 100.0; }
inline TimeNs to_milliseconds(TimeNs t) { return t / kMillisecond * kMillisecond; }

}  // namespace karst::core
