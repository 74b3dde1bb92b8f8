#include "core_stack/homing/path_home/homing_tree.h"

#include <algorithm>
#include <tuple>

namespace karst::core {
namespace {

/// The minimal edge length: with zero-length edges, paths could contain cycles.
constexpr double kMinLength_m = 0.01;
constexpr std::size_t kMaxRays = 1024;  // maximal number of rays of a node; in flight there are tens

std::tuple<NodeKind, double, double, double> rank(const TreeNode& n) {
  return {n.kind, n.position.x(), n.position.y(), n.position.z()};
}

/// Whether the segment intersects the box: tests its bounding box first, then clips.
bool meets_box(const Vec3& a, const Vec3& b, const Vec3& low, const Vec3& high) {
  double first = 0, last = 1;
  for (int i = 0; i < 3; ++i) {
    const double d = b[i] - a[i];
    if (std::abs(d) < 1e-12) {
      if (a[i] < low[i] || a[i] > high[i]) return false;
      continue;
    }
    const double s = (low[i] - a[i]) / d, t = (high[i] - a[i]) / d;
    first = std::max(first, std::min(s, t));
    last = std::min(last, std::max(s, t));
  }
  return first <= last;
}

}  // namespace

void describe(OptionTable& t, HomingTreeOptions& o) {
  t.add("min_edge", o.min_edge_m, "m", 0.2, 20, "poses nearer than that to a node add none");
  t.add("longest_edge", o.longest_edge_m, "m", 1, 100, "rays between nodes are looked at up to this length");
  t.add("max_nodes", o.max_nodes, 10, 1e6, "nodes beyond are refused");
}

HomingTree::HomingTree(const HomingTreeOptions& options, double cruise_mps)
    : options_(options), cruise_mps_(cruise_mps), grid_(options.longest_edge_m) {}

TreeFacts HomingTree::insert_pose(const NodeId& id, const Vec3& position, TimeNs stamp,
                                  const FreeRay& free_ray) {
  const TreeNode node{id, NodeKind::pose, to_centimetres(position)};
  TreeFacts facts;
  if (!near(node.position, options_.min_edge_m - 1e-9).empty() || !place(node)) return facts;
  facts.nodes = {node};
  add_free_rays(*find(id), to_milliseconds(stamp), free_ray, facts);
  paths_.relax();
  return facts;
}

TreeFacts HomingTree::insert_communication(const NodeId& id, const Vec3& position, TimeNs stamp,
                                           const FreeRay& free_ray) {
  const TreeNode node{id, NodeKind::communication, to_centimetres(position)};
  TreeFacts facts;
  if (!place(node)) return facts;
  facts.nodes = {node};
  add_free_rays(*find(id), to_milliseconds(stamp), free_ray, facts);
  paths_.relax();
  return facts;
}

TreeFacts HomingTree::set_alive(const NodeId& id, bool alive, TimeNs stamp) {
  TreeFacts facts;
  facts.lives = {{id, alive, to_milliseconds(stamp)}};
  apply(facts);
  return facts;
}

TreeFacts HomingTree::look_from(const NodeId& id, TimeNs stamp, const FreeRay& free_ray) {
  TreeFacts facts;
  if (const auto i = find(id); i && entries_[*i].known)
    add_free_rays(*i, to_milliseconds(stamp), free_ray, facts);
  paths_.relax();
  return facts;
}

void HomingTree::add_free_rays(std::uint32_t i, TimeNs stamp, const FreeRay& free_ray, TreeFacts& facts) {
  for (const std::uint32_t k : near(entries_[i].node.position, options_.longest_edge_m)) {
    if (k == i || ray(i, k) != nullptr || !ask(i, k, free_ray)) continue;
    const RayFact fact{entries_[i].node.id, entries_[k].node.id, true, stamp};
    if (set_ray(fact)) facts.rays.push_back(fact);
  }
}

TreeFacts HomingTree::recheck(const Vec3& low, const Vec3& high, double margin_m, TimeNs stamp,
                              const FreeRay& free_ray, const FreeRay& rock) {
  const Vec3 margin = Vec3::Constant(margin_m), radius = Vec3::Constant(options_.longest_edge_m + margin_m);
  std::vector<std::uint32_t> touched;
  grid_.for_each_in_box(low - radius, high + radius,
                        [&](std::uint32_t i, const Vec3&) { touched.push_back(i); });
  TreeFacts facts;
  for (const std::uint32_t i : touched)
    for (const std::uint32_t k : near(entries_[i].node.position, options_.longest_edge_m)) {
      const TreeNode &a = entries_[i].node, &b = entries_[k].node;
      if (!(a.id < b.id) || !meets_box(a.position, b.position, low - margin, high + margin)) continue;
      const Ray* known = ray(i, k);
      const bool was_free = known != nullptr && known->free;
      if (was_free ? !ask(i, k, rock) : !ask(i, k, free_ray)) continue;
      // A new observation supersedes earlier reports, even by a robot whose clock is ahead.
      const TimeNs later = std::max(to_milliseconds(stamp), known ? known->stamp + kMillisecond : 0);
      const RayFact fact{a.id, b.id, !was_free, later};
      if (set_ray(fact)) facts.rays.push_back(fact);
    }
  paths_.relax();
  return facts;
}

std::size_t HomingTree::apply(const TreeFacts& facts) {
  std::size_t refused = 0;
  for (const TreeNode& n : facts.nodes) refused += !place(n);
  for (const RayFact& r : facts.rays) refused += !set_ray(r);
  for (const LifeFact& l : facts.lives) refused += !set_life(l);
  paths_.relax();
  return refused;
}

std::optional<std::uint32_t> HomingTree::find(const NodeId& id) const {
  const auto found = index_.find(id.name());
  if (found == index_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::uint32_t> HomingTree::find_or_name(const NodeId& id) {
  if (const auto i = find(id)) return i;
  if (entries_.size() >= static_cast<std::size_t>(options_.max_nodes)) return std::nullopt;
  const std::uint32_t i = paths_.add(id.name());
  entries_.emplace_back().node.id = id;
  index_.emplace(id.name(), i);
  return i;
}

/// Robots do not create two nodes with one id; but if it happens, the tree must not depend on the order of
/// arrival.
bool HomingTree::place(const TreeNode& node) {
  if (!node.position.allFinite() || node.position.cwiseAbs().maxCoeff() > 1e6) return false;
  const auto i = find_or_name(node.id);
  if (!i) return false;
  if (entries_[*i].known) {
    if (!(rank(node) < rank(entries_[*i].node))) return true;
    detach(*i);
  }
  entries_[*i].node = node;
  attach(*i);
  return true;
}

void HomingTree::attach(std::uint32_t i) {
  Entry& e = entries_[i];
  e.known = true;
  ++known_;
  grid_.add(i, e.node.position);
  paths_.set_source(i, e.node.kind == NodeKind::communication && e.alive);
  for (const Ray& r : e.rays)
    if (r.free && entries_[r.to].known) paths_.join(i, r.to, cost_between(i, r.to));
}

void HomingTree::detach(std::uint32_t i) {
  Entry& e = entries_[i];
  for (const Ray& r : e.rays)
    if (r.free && entries_[r.to].known) paths_.part(i, r.to);
  paths_.set_source(i, false);
  grid_.remove(i, e.node.position);
  e.known = false;
  --known_;
}

bool HomingTree::set_ray(const RayFact& fact) {
  if (fact.a == fact.b || fact.stamp < 0) return false;
  const auto i = find_or_name(fact.a), k = find_or_name(fact.b);
  if (!i || !k) return false;
  const auto entry_of = [this](std::uint32_t from, std::uint32_t to) -> Ray& {
    for (Ray& r : entries_[from].rays)
      if (r.to == to) return r;
    return entries_[from].rays.emplace_back(Ray{to, false, -1});
  };
  if (ray(*i, *k) == nullptr && std::max(entries_[*i].rays.size(), entries_[*k].rays.size()) >= kMaxRays)
    return false;
  Ray &there = entry_of(*i, *k), &back = entry_of(*k, *i);
  if (fact.stamp < there.stamp || (fact.stamp == there.stamp && fact.free)) return true;
  const bool was_free = there.free;
  there.free = back.free = fact.free;
  there.stamp = back.stamp = fact.stamp;
  if (fact.free == was_free || !entries_[*i].known || !entries_[*k].known) return true;
  if (fact.free)
    paths_.join(*i, *k, cost_between(*i, *k));
  else
    paths_.part(*i, *k);
  return true;
}

bool HomingTree::set_life(const LifeFact& fact) {
  if (fact.stamp < 0) return false;
  const auto i = find_or_name(fact.id);
  if (!i) return false;
  Entry& e = entries_[*i];
  if (fact.stamp < e.life_stamp || (fact.stamp == e.life_stamp && fact.alive)) return true;
  e.alive = fact.alive;
  e.life_stamp = fact.stamp;
  if (e.known) paths_.set_source(*i, e.alive && e.node.kind == NodeKind::communication);
  return true;
}

bool HomingTree::ask(std::uint32_t i, std::uint32_t k, const FreeRay& free_ray) const {
  const TreeNode &a = entries_[i].node, &b = entries_[k].node;
  return a.id < b.id ? free_ray(a.position, b.position) : free_ray(b.position, a.position);
}

const HomingTree::Ray* HomingTree::ray(std::uint32_t i, std::uint32_t k) const {
  for (const Ray& r : entries_[i].rays)
    if (r.to == k) return &r;
  return nullptr;
}

double HomingTree::cost_between(std::uint32_t i, std::uint32_t k) const {
  const double length_m = (entries_[i].node.position - entries_[k].node.position).norm();
  return std::max(length_m, kMinLength_m) / cruise_mps_;
}

std::vector<std::uint32_t> HomingTree::near(const Vec3& p, double radius_m) const {
  std::vector<std::uint32_t> out;
  grid_.for_each_within(p, radius_m, [&](std::uint32_t i, const Vec3&) { out.push_back(i); });
  return out;
}

}  // namespace karst::core
