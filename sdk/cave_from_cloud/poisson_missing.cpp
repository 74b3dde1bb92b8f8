// Stands in for poisson.cpp in a build without PCL.
#include <stdexcept>

#include "sdk/cave_from_cloud/poisson.h"

namespace karst::from_cloud {

bool has_poisson() { return false; }

cave::TriangleMesh poisson_surface(const PointCloud&, double) {
  throw std::logic_error("built without PCL: has_poisson() must be asked first");
}

}  // namespace karst::from_cloud
