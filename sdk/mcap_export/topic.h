// A topic of an exported flight, and how several become one file.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sdk/mcap_export/flight_clock.h"
#include "sdk/mcap_export/mcap_writer.h"
#include "sdk/mcap_export/message_schema.h"

namespace karst::mcap {

struct StampedBytes {
  std::uint64_t time_ns = 0;
  std::string message;
};

/// The next message, none at the end. Their times do not fall.
using Source = std::function<std::optional<StampedBytes>()>;

/// Late subscribers get the last message of a latched topic, such as /tf_static.
enum class Durability { as_it_comes, latched };

struct Topic {
  std::string name;
  ros::MessageSchema schema;
  Source next;
  Durability durability = Durability::as_it_comes;
};

struct TopicCount {
  std::string name, type;
  std::uint64_t messages = 0;
};

/// Writes the messages of all topics in the order of time; those of one time in the order of the topics. One
/// message of each topic is in memory. Topics of one name are one channel; a topic without messages is none.
/// Ends early if the writer's stream fails. `writer` has no channels yet.
std::vector<TopicCount> write_topics(McapWriter& writer, std::vector<Topic> topics);

/// `make(i)` gives the time and the message number i of `count`.
template <ros::Message M, class Make>
Topic topic_of(std::string name, const FlightClock& clock, std::size_t count, Make make,
               Durability durability = Durability::as_it_comes) {
  return {
      std::move(name), ros::schema_of<M>(),
      [clock, count, make = std::move(make), i = std::size_t{0}]() mutable -> std::optional<StampedBytes> {
        if (i == count) return std::nullopt;
        const std::pair<double, M> stamped = make(i++);
        return StampedBytes{clock.ns(stamped.first), ros::cdr_of(stamped.second)};
      },
      durability};
}

/// Of messages that are there already.
template <ros::Message M>
Topic topic_of(std::string name, const FlightClock& clock, std::vector<std::pair<double, M>> messages,
               Durability durability = Durability::as_it_comes) {
  auto all = std::make_shared<const std::vector<std::pair<double, M>>>(std::move(messages));
  const std::size_t count = all->size();
  return topic_of<M>(
      std::move(name), clock, count, [all](std::size_t i) { return (*all)[i]; }, durability);
}

}  // namespace karst::mcap
