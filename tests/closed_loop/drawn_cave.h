// Caves drawn with boxes: rooms, corridors and shafts of a width known to the millimetre.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace karst {

/// Free space from `low` to `high`, metres.
struct Box {
  double low[3], high[3];
};

/// Writes the surface of the union of `boxes`, turned about the vertical by `turn_rad`, as folder/cave.obj,
/// and folder/cave.info, which starts at the point `start` (turned with it). Returns the .info file.
inline std::string draw_cave(const std::filesystem::path& folder, const std::vector<Box>& boxes,
                             const double (&start)[3], double turn_rad = 0) {
  // Along the coordinates of all faces space falls into cells that are wholly free or wholly rock.
  std::vector<double> at[3];
  for (int a = 0; a < 3; ++a) {
    for (const Box& b : boxes) at[a].push_back(b.low[a]), at[a].push_back(b.high[a]);
    std::sort(at[a].begin(), at[a].end());
    at[a].erase(std::unique(at[a].begin(), at[a].end()), at[a].end());
  }
  const auto free = [&](const int(&c)[3]) {
    double middle[3];
    for (int a = 0; a < 3; ++a) {
      if (c[a] < 0 || c[a] + 1 >= static_cast<int>(at[a].size())) return false;
      middle[a] = (at[a][static_cast<std::size_t>(c[a])] + at[a][static_cast<std::size_t>(c[a]) + 1]) / 2;
    }
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) {
      for (int a = 0; a < 3; ++a)
        if (middle[a] < b.low[a] || middle[a] > b.high[a]) return false;
      return true;
    });
  };
  const double cosine = std::cos(turn_rad), sine = std::sin(turn_rad);
  std::ofstream mesh(folder / "cave.obj");
  int vertices = 0;
  const auto vertex = [&](double x, double y, double z) {
    mesh << "v " << cosine * x - sine * y << ' ' << sine * x + cosine * y << ' ' << z << '\n';
    ++vertices;
  };
  const int n[3] = {static_cast<int>(at[0].size()), static_cast<int>(at[1].size()),
                    static_cast<int>(at[2].size())};
  int c[3];
  for (c[0] = 0; c[0] + 1 < n[0]; ++c[0])
    for (c[1] = 0; c[1] + 1 < n[1]; ++c[1])
      for (c[2] = 0; c[2] + 1 < n[2]; ++c[2]) {
        if (!free(c)) continue;
        for (int face = 0; face < 6; ++face) {
          const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
          int beside[3] = {c[0], c[1], c[2]};
          beside[axis] += face % 2 ? 1 : -1;
          if (free(beside)) continue;
          for (int corner = 0; corner < 4; ++corner) {
            int k[3] = {c[0], c[1], c[2]};
            k[axis] += face % 2;
            k[u] += corner == 1 || corner == 2;
            k[v] += corner >= 2;
            vertex(at[0][static_cast<std::size_t>(k[0])], at[1][static_cast<std::size_t>(k[1])],
                   at[2][static_cast<std::size_t>(k[2])]);
          }
          mesh << "f " << vertices - 3 << ' ' << vertices - 2 << ' ' << vertices - 1 << ' ' << vertices
               << '\n';
        }
      }
  std::ofstream(folder / "cave.info")
      << "mesh cave.obj\nstart \"" << cosine * start[0] - sine * start[1] << ' '
      << sine * start[0] + cosine * start[1] << ' ' << start[2] << ' ' << turn_rad * 180 / M_PI << "\"\n";
  return (folder / "cave.info").string();
}

/// A passage of 90 m with a bend and a chamber half way, 4 m wide.
inline std::string passage_cave(const std::filesystem::path& folder) {
  return draw_cave(folder,
                   {{{-4, -4, 0}, {4, 4, 3}},
                    {{3, -2, 0}, {40, 2, 3}},
                    {{32, -5, 0}, {42, 5, 4}},
                    {{36, 4, 0}, {40, 50, 3}}},
                   {0, 0, 1});
}

}  // namespace karst
