// A map drawn by hand, for a policy's own tests.
//
//   const karst::testing::DrawnMap map(0.5, {R"(
//     #######
//     #a..b?
//     #######)"});
//
// A layer is seen from above: the first row is the northernmost. '#' is occupied, '?' unknown, '.' free; a
// letter is a free cell with a name. Blanks before a row are ignored; cells after the end of a short row and
// outside the drawing are unknown. Layers are listed bottom first. The lower south-western corner is the
// world's origin. A legend defines other characters; fill(), room() and tube() add what is tedious to draw.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <queue>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <karst/types.h>

namespace karst::testing {

struct Index {
  int x = 0, y = 0, z = 0;
  bool operator<(const Index& o) const { return std::tie(x, y, z) < std::tie(o.x, o.y, o.z); }
  bool operator==(const Index& o) const { return std::tie(x, y, z) == std::tie(o.x, o.y, o.z); }
};

class DrawnMap {
 public:
  using Legend = std::map<char, Cell>;  // adds characters to '#', '.', '?' and letters, or replaces them

  DrawnMap(double resolution_m, const std::vector<std::string>& layers, const Legend& legend = {})
      : resolution_m_(resolution_m), layers_(layers.size()) {
    for (std::size_t z = 0; z < layers.size(); ++z) draw(layers[z], static_cast<int>(z), legend);
  }

  /// Sets every cell whose centre lies in the closed box (world, m).
  DrawnMap& fill(const Box& box, Cell cell) {
    const Index low = index_of(box.low), high = index_of(box.high);
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y)
        for (int z = low.z; z <= high.z; ++z) {
          const Vec3 c = center_of({x, y, z});
          const bool inside = c.x >= box.low.x && c.y >= box.low.y && c.z >= box.low.z && c.x <= box.high.x &&
                              c.y <= box.high.y && c.z <= box.high.z;
          if (inside) set({x, y, z}, cell);
        }
    return *this;
  }
  /// Adds a free box (world, m), with a wall of one cell around it.
  DrawnMap& room(const Box& inside) {
    const Vec3 wall{resolution_m_, resolution_m_, resolution_m_};
    return fill({inside.low - wall, inside.high + wall}, Cell::occupied).fill(inside, Cell::free);
  }
  /// Adds a tube that is free within `radius_m` of the segment (world, m), with a wall of one cell around it
  /// and open at both ends. Cells that are free already stay free.
  DrawnMap& tube(const Vec3& from, const Vec3& to, double radius_m) {
    const double length = distance(from, to), reach = radius_m + resolution_m_;
    const Vec3 margin{reach, reach, reach};
    const Index low =
        index_of(Vec3(std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)) - margin);
    const Index high =
        index_of(Vec3(std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z)) + margin);
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y)
        for (int z = low.z; z <= high.z; ++z) {
          const Vec3 c = center_of({x, y, z});
          const double along = length > 0 ? dot(c - from, to - from) / length : 0;
          if (along < -1e-9 || along > length + 1e-9) continue;
          const double off = distance(c, from + (length > 0 ? along / length : 0.0) * (to - from));
          if (off <= radius_m)
            set({x, y, z}, Cell::free);
          else if (off <= reach && at(Index{x, y, z}) != Cell::free)
            set({x, y, z}, Cell::occupied);
        }
    return *this;
  }
  void set(const Index& i, Cell cell) {
    if (cell == Cell::unknown)
      known_.erase(i);
    else
      known_[i] = cell;
  }

  double resolution_m() const { return resolution_m_; }
  std::size_t layers() const { return layers_; }  // number of drawn layers
  const std::map<Index, Cell>& known() const { return known_; }
  /// The least box (world, m) with all known cells in it; the origin without any.
  Box bounds() const {
    if (known_.empty()) return {};
    Index low = known_.begin()->first, high = low;
    for (const auto& [i, cell] : known_) {
      low = {std::min(low.x, i.x), std::min(low.y, i.y), std::min(low.z, i.z)};
      high = {std::max(high.x, i.x), std::max(high.y, i.y), std::max(high.z, i.z)};
    }
    const Vec3 half = 0.5 * resolution_m_ * Vec3(1, 1, 1);
    return {center_of(low) - half, center_of(high) + half};
  }
  Cell at(const Index& i) const {
    const auto found = known_.find(i);
    return found == known_.end() ? Cell::unknown : found->second;
  }
  Cell at(const Vec3& p) const { return at(index_of(p)); }
  Index index_of(const Vec3& p) const {
    const auto cell = [&](double v) { return static_cast<int>(std::floor(v / resolution_m_)); };
    return {cell(p.x), cell(p.y), cell(p.z)};
  }
  Vec3 center_of(const Index& i) const {
    return {(i.x + 0.5) * resolution_m_, (i.y + 0.5) * resolution_m_, (i.z + 0.5) * resolution_m_};
  }
  /// Centre (world, m) of the cell named by a letter. Throws std::out_of_range if there is none.
  Vec3 place(char letter) const {
    const auto found = places_.find(letter);
    if (found == places_.end()) throw std::out_of_range(std::string("no cell is named ") + letter);
    return center_of(found->second);
  }

  struct Route {
    double length_m = std::numeric_limits<double>::infinity();  // from cell to cell
    std::vector<Vec3> points;  // `from`, centres of the cells between, `to`; none without a path
  };
  /// The shortest path through free cells that share a face, edge or corner.
  Route route(const Vec3& from, const Vec3& to) const {
    const Index start = index_of(from), goal = index_of(to);
    if (at(start) != Cell::free || at(goal) != Cell::free) return {};
    struct Reached {
      double length;
      Index before;
    };
    std::map<Index, Reached> best{{start, {0.0, start}}};
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    open.push({0.0, start});
    while (!open.empty()) {
      const auto [length, i] = open.top();
      open.pop();
      if (i == goal) {
        Route out{length * resolution_m_, {to}};
        for (Index k = i; !(k == start);) {
          k = best.at(k).before;
          if (!(k == start)) out.points.push_back(center_of(k));
        }
        out.points.push_back(from);
        std::reverse(out.points.begin(), out.points.end());
        return out;
      }
      if (length > best.at(i).length) continue;
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dz = -1; dz <= 1; ++dz) {
            const Index n{i.x + dx, i.y + dy, i.z + dz};
            if (at(n) != Cell::free) continue;
            const double there = length + std::sqrt(static_cast<double>(dx * dx + dy * dy + dz * dz));
            const auto known_best = best.find(n);
            if (known_best != best.end() && known_best->second.length <= there) continue;
            best[n] = {there, i};
            open.push({there, n});
          }
    }
    return {};
  }
  /// Length (m) of the shortest path through free cells that share a face, edge or corner; +infinity if none.
  double path_length_m(const Vec3& from, const Vec3& to) const { return route(from, to).length_m; }

 private:
  void draw(const std::string& layer, int z, const Legend& legend) {
    std::vector<std::string> rows;
    std::istringstream in(layer);
    for (std::string row; std::getline(in, row);) {
      row.erase(0, std::min(row.find_first_not_of(" \t"), row.size()));
      if (!row.empty()) rows.push_back(row);
    }
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t x = 0; x < rows[r].size(); ++x) {
        const Index i{static_cast<int>(x), static_cast<int>(rows.size() - 1 - r), z};
        const char c = rows[r][x];
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        if (const auto meaning = legend.find(c); meaning != legend.end())
          set(i, meaning->second);
        else if (c == '#')
          known_[i] = Cell::occupied;
        else if (c == '.' || is_letter)
          known_[i] = Cell::free;
        else if (c != '?')
          throw std::invalid_argument(std::string("a drawn map holds '#', '.', '?' and letters, not '") + c +
                                      "'");
        if (is_letter && at(i) == Cell::free) places_[c] = i;
      }
  }

  double resolution_m_;
  std::size_t layers_;
  std::map<Index, Cell> known_;
  std::map<char, Index> places_;
};

}  // namespace karst::testing
