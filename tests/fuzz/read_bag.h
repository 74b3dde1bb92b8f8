// Reads all of a bag, and decodes the messages that a replay would.
#pragma once
#include <string>

#include "plugins/replay/bag/sensor_messages.h"

namespace karst::fuzz {

inline void read_bag(const std::string& path) {
  const auto bag = replay::open_bag(path);
  replay::MessageDecoder decoder(bag->connections());
  while (const auto m = bag->next()) {
    const std::string& type = bag->connections()[m->connection].type;
    try {
      const replay::Message message = decoder.decode(m->connection, m->bytes);
      if (replay::is_cloud_type(type)) replay::cloud_of(type, message, {});
      if (type == "sensor_msgs/Imu") replay::imu_of(message);
      if (type == "tf2_msgs/TFMessage") replay::transforms_of(message);
    } catch (const replay::MalformedError&) {
      continue;  // what a replay leaves out
    }
  }
}

}  // namespace karst::fuzz
