// A definition, a byte of zero, and a message that is decoded by it, also as a scan: whatever types the
// definition gives to a scan's members.
#include <algorithm>
#include <cstdint>

#include "plugins/replay/bag/sensor_messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace karst::replay;
  const Bytes bytes(reinterpret_cast<const char*>(data), size);
  const auto zero = static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), '\0') - bytes.begin());
  const Bytes stored = bytes.subspan(std::min(size, zero + 1));
  for (const Dialect dialect : {Dialect::ros1, Dialect::ros2}) try {
      const MessageType type = parse_message_type("package/Type", {bytes.data(), zero}, dialect);
      const Message message = Message::of(type, stored, dialect);
      for (const MessageField& f : type.fields)
        if (f.kind == MessageField::Kind::structure) message.structures(f.path);
      for (const char* scan : {"sensor_msgs/PointCloud2", "livox_ros_driver2/CustomMsg"}) try {
          cloud_of(scan, message, {});
        } catch (const MalformedError&) {
        }
    } catch (const MalformedError&) {
    }
  return 0;
}
