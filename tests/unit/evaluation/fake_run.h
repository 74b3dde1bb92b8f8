// A made-up run directory: a flight through a winding analytic tunnel and back, with every file a run writes.
#pragma once
#include <filesystem>

#include "core_stack/common/geometry.h"

namespace karst::test {

struct FakeRunOptions {
  double length_m = 60;        // of the tunnel
  double speed_mps = 1.5;      // while exploring and on the way home
  double drift_per_m = 0.002;  // error of the estimate along x, a metre of path
  double map_resolution_m = 0.2;
};

/// Centre of the tunnel at distance s from the start (along x), and its radius there.
core::Vec3 tunnel_centre(double s);
double tunnel_radius(double s);

/// Writes all files except map.bt into `dir`, which is created.
void write_fake_run(const std::filesystem::path& dir, const FakeRunOptions& options = {});

/// A fresh directory below the system's temporary one, removed with its content at the end of its life.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Writes a file in it.
  void write(const std::string& name, const std::string& bytes) const;

 private:
  std::filesystem::path path_;
};

}  // namespace karst::test
