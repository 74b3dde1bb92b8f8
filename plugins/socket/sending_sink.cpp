#include "plugins/socket/sending_sink.h"

namespace karst::socket {

SendingSink::SendingSink(Stream& client, const core::VehicleDescription& vehicle, std::function<void()> pause)
    : client_(client), vehicle_(vehicle), pause_(std::move(pause)) {}

std::uint16_t SendingSink::number_of(const core::CameraModel* camera) const {
  for (std::size_t i = 0; i < vehicle_.cameras.size(); ++i)
    if (vehicle_.cameras[i].get() == camera) return static_cast<std::uint16_t>(i);
  return kRgbCamera;
}

}  // namespace karst::socket
