// What is served: topics, and their messages as bytes that all clients share.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "sdk/mcap_export/message_schema.h"

namespace karst::live {

/// What a client gets of a topic when it subscribes, and what becomes of the topic's messages when it is
/// slow.
enum class Keeping : std::uint8_t {
  none,   // nothing: it begins with the next message; the oldest are dropped
  last,   // the last message; the oldest are dropped
  whole,  // the last message, as it tells all that has grown; one that waits is replaced by the next
  since_latest_map,  // what has been added to the last /map; the oldest are dropped
};

struct LiveTopic {
  std::string name;
  ros::MessageSchema schema;
  Keeping keeping = Keeping::none;
};

struct LiveMessage {
  std::size_t topic = 0;      // its place in the list of topics
  std::uint64_t time_ns = 0;  // flight time
  std::shared_ptr<const std::string> bytes;
};

}  // namespace karst::live
