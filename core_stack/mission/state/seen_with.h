// What new rays of the map were measured with.
#pragma once

namespace karst::core {

enum class SeenWith { lidar, camera };

}  // namespace karst::core
