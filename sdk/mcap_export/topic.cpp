#include "sdk/mcap_export/topic.h"

#include <map>
#include <queue>
#include <tuple>

namespace karst::mcap {
namespace {

/// What rosbag2 offers to subscribers when it plays the channel: reliable, the last thousand kept; times
/// without limit. The numbers are those of rmw's enumerations.
std::string offered_qos(Durability durability) {
  const auto unlimited = [](const char* name) {
    return std::string("  ") + name + ":\n    sec: 9223372036\n    nsec: 854775807\n";
  };
  return "- history: 1\n  depth: 1000\n  reliability: 1\n  durability: " +
         std::string(durability == Durability::latched ? "1" : "2") + "\n" + unlimited("deadline") +
         unlimited("lifespan") + "  liveliness: 1\n" + unlimited("liveliness_lease_duration") +
         "  avoid_ros_namespace_conventions: false";
}

}  // namespace

std::vector<TopicCount> write_topics(McapWriter& writer, std::vector<Topic> topics) {
  std::vector<TopicCount> counts;  // by channel
  std::map<std::string, ChannelId> channels;
  std::vector<std::optional<StampedBytes>> next(topics.size());
  using Due = std::tuple<std::uint64_t, std::size_t>;  // time and topic
  std::priority_queue<Due, std::vector<Due>, std::greater<>> due;
  const auto advance = [&](std::size_t i) {
    next[i] = topics[i].next();
    if (next[i]) due.emplace(next[i]->time_ns, i);
  };
  for (std::size_t i = 0; i < topics.size(); ++i) {
    advance(i);
    const Topic& topic = topics[i];
    if (!next[i] || channels.contains(topic.name)) continue;
    counts.push_back({topic.name, topic.schema.name, 0});
    channels[topic.name] = writer.add_channel({topic.name,
                                               "cdr",
                                               topic.schema.name,
                                               "ros2msg",
                                               topic.schema.definition,
                                               {{"offered_qos_profiles", offered_qos(topic.durability)}}});
  }
  while (!due.empty() && writer.good()) {
    const auto [time_ns, i] = due.top();
    due.pop();
    const ChannelId channel = channels.at(topics[i].name);
    writer.write(channel, time_ns, next[i]->message);
    ++counts[channel].messages;
    advance(i);
  }
  return counts;
}

}  // namespace karst::mcap
