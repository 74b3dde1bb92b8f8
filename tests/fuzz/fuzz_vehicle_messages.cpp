// Any bytes from the socket, at both ends: they are refused, or what was read can be written again as it
// came. The first byte says which end reads; then follow frames, as Stream cuts them.
#include <cstdlib>
#include <cstring>
#include <variant>

#include "plugins/socket/plausible.h"
#include "plugins/socket/wire.h"

using namespace karst::socket;

namespace {

template <class Variant>
void read_all(std::string_view bytes) {
  while (bytes.size() >= kHeaderBytes) {
    std::uint32_t size = 0;
    std::uint16_t type = 0;
    std::memcpy(&size, bytes.data(), 4);
    std::memcpy(&type, bytes.data() + 4, 2);
    bytes.remove_prefix(kHeaderBytes);
    const Frame frame{type, bytes.substr(0, size)};
    bytes.remove_prefix(frame.body.size());
    std::string problem;
    const auto message = read_message<Variant>(frame, problem);
    if (!message) {
      if (problem.empty()) std::abort();
      continue;
    }
    std::string again;
    std::visit([&again](const auto& m) { append_message(again, m); }, *message);
    if (std::string_view(again).substr(kHeaderBytes) != frame.body) std::abort();
    karst::core::VehicleDescription vehicle;
    if constexpr (std::is_same_v<Variant, ToCore>) {
      if (const auto* welcome = std::get_if<Welcome>(&*message))
        if (implausible(welcome->description).empty()) vehicle = welcome->description;
      implausible(*message, vehicle);
    } else if (const auto* command = std::get_if<karst::core::Command>(&*message)) {
      implausible(*command);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 2 == 0)
    read_all<ToCore>(bytes);
  else
    read_all<ToVehicle>(bytes);
  return 0;
}
