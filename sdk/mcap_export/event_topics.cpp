#include <algorithm>

#include "sdk/mcap_export/event_messages.h"
#include "sdk/mcap_export/flight_topics.h"

namespace karst::mcap {
namespace {

using Events = std::vector<TimedEvent>;

Events events_of(const evaluation::RunRecord& run) {
  Events out;
  for (const nlohmann::json& line : run.events)
    if (auto e = core::event::read(line)) out.push_back({line["t"].get<double>(), std::move(*e)});
  std::stable_sort(out.begin(), out.end(),
                   [](const TimedEvent& a, const TimedEvent& b) { return a.t_s < b.t_s; });
  return out;
}

template <class Messages>
Topic topic_of_events(Messages messages, const Events& events, const FlightClock& clock) {
  using M = typename Messages::Message;
  std::vector<std::pair<double, M>> out;
  const auto put = [&](std::optional<Stamped<M>> made) {
    if (made) out.emplace_back(made->t_s, std::move(made->message));
  };
  for (const TimedEvent& e : events) put(messages.take(e, clock));
  put(end_of(messages));
  return topic_of<M>(Messages::kTopic, clock, std::move(out));
}

}  // namespace

std::vector<Topic> event_topics(const evaluation::RunRecord& run, const FlightClock& clock) {
  const Events events = events_of(run);
  return std::apply(
      [&](auto... messages) { return std::vector<Topic>{topic_of_events(messages, events, clock)...}; },
      EventMessages{});
}

}  // namespace karst::mcap
