#include "sdk/vehicle_server/conformance_client.h"

#include "core_stack/common/printable.h"

namespace karst::vehicle_server {

using core::TimeNs;
using socket::LinkError;
using socket::Wait;

namespace {

constexpr TimeNs kCommandPeriod = 10 * core::kMillisecond, kPingPeriod = 100 * core::kMillisecond;
constexpr Wait kPatience{10'000};

TimeNs machine_time() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

ConformanceClient::ConformanceClient(const socket::Address& address)
    : stream_(socket::connect_to(address, Wait(5000), socket::kMaxToCoreBytes)) {}

ConformanceClient::~ConformanceClient() {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  try {
    say(socket::Bye{"checked"});
    while (std::chrono::steady_clock::now() < until) {
      while (stream_.next()) {
      }
      stream_.receive(Wait(100));
    }
  } catch (const LinkError&) {  // closed, as it should be
  }
}

void ConformanceClient::say_bytes(const std::string& bytes) {
  stream_.queue_bytes(bytes);
  stream_.flush(Wait(2000));
}

std::optional<socket::ToCore> ConformanceClient::hear(Wait patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    if (const auto frame = stream_.next()) {
      std::string problem;
      auto message = socket::read_message<socket::ToCore>(*frame, problem);
      if (!message) throw LinkError(problem);
      return message;
    }
    const auto left = std::chrono::duration_cast<Wait>(until - std::chrono::steady_clock::now());
    if (!stream_.receive(std::max(Wait(0), left))) return std::nullopt;
  }
}

socket::Welcome ConformanceClient::greet(socket::FlightClock clock) {
  socket::Hello hello;
  hello.clock = clock;
  hello.climb_m = 0.5;
  hello.client = "karst vehicle check";
  say(hello);
  const auto answer = hear(Wait(60'000));
  if (!answer) throw LinkError("no answer to the greeting within 60 s");
  if (const auto* refuse = std::get_if<socket::Refuse>(&*answer))
    throw LinkError("refused: " + core::printable(refuse->reason));
  const auto* welcome = std::get_if<socket::Welcome>(&*answer);
  if (!welcome) throw LinkError("the answer to the greeting is neither welcome nor refuse");
  return *welcome;
}

void ConformanceClient::start() {
  say(socket::Start{});
  std::vector<Heard> heard;
  take_answer(heard);
  if (!heard.empty()) throw LinkError("the answer to start has measurements: they belong into slots");
}

void ConformanceClient::take_answer(std::vector<Heard>& heard) {
  for (;;) {
    auto message = hear(kPatience);
    if (!message) throw LinkError("no answer within 10 s");
    if (const auto* done = std::get_if<socket::Done>(&*message)) {
      if (done->time != now_) throw LinkError("done: says another time than that of the request");
      return;
    }
    if (std::holds_alternative<socket::Pause>(*message)) {
      say(socket::Resume{});
    } else if (const auto* s = std::get_if<socket::Schedule>(&*message)) {
      if (s->due < now_ || (s->period != 0 && s->period < core::kMillisecond))
        throw LinkError("schedule: a time that is past, or a period below 1 ms");
      slots_[{s->due, schedules_++}] = {s->slot, s->period};
    } else if (const auto* bye = std::get_if<socket::Bye>(&*message)) {
      throw LinkError("the vehicle left: " + core::printable(bye->reason));
    } else if (!std::holds_alternative<socket::Checks>(*message)) {
      heard.push_back({std::move(*message), now_});
    }
  }
}

void ConformanceClient::fly(TimeNs until, const std::optional<core::Command>& command,
                            std::vector<Heard>& heard) {
  if (slots_.empty()) throw LinkError("the vehicle has scheduled nothing");
  while (!slots_.empty() && slots_.begin()->first.first <= until) {
    const auto [key, slot] = *slots_.begin();
    slots_.erase(slots_.begin());
    if (slot.period > 0) slots_[{key.first + slot.period, key.second}] = slot;
    for (; next_command_ < key.first; next_command_ += kCommandPeriod)
      if (command) stream_.queue(*command);
    now_ = key.first;
    say(socket::Run{slot.number, now_});
    take_answer(heard);
  }
}

void ConformanceClient::fly_real_time(TimeNs time, const std::optional<core::Command>& command,
                                      std::vector<Heard>& heard) {
  const TimeNs begin = machine_time();
  TimeNs next_command = begin, next_ping = begin;
  for (TimeNs now = begin; now < begin + time; now = machine_time()) {
    if (command && now >= next_command) {
      stream_.queue(*command);
      next_command += kCommandPeriod;
    }
    if (now >= next_ping) {
      stream_.queue(socket::Ping{now});
      next_ping += kPingPeriod;
    }
    stream_.flush(Wait(100));
    if (auto message = hear(Wait(2))) heard.push_back({std::move(*message), machine_time()});
  }
}

}  // namespace karst::vehicle_server
