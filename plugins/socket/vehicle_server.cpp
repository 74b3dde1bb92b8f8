#include "plugins/socket/vehicle_server.h"

#include <algorithm>
#include <cstring>

#include "core_stack/common/error.h"
#include "plugins/socket/mirrored_executive.h"
#include "plugins/socket/plausible.h"
#include "plugins/socket/sending_sink.h"

namespace karst::socket {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

namespace {

constexpr Wait kPiece{100};  // between two looks at `interrupted`
constexpr TimeNs kComesDownWithin = 120 * kSecond;
constexpr TimeNs kReadPeriod = kMillisecond;  // of reading, in real time
constexpr const char* kStopped = "stopped by its operator";
constexpr std::size_t kMessagesAtOnce = 64;

/// The client's messages. Throws LinkError where there can be none any more.
class Client {
 public:
  Client(Stream& stream, const std::atomic<bool>& interrupted) : stream_(stream), interrupted_(interrupted) {}

  Stream& stream() { return stream_; }

  std::optional<ToVehicle> poll() {
    auto frame = stream_.next();
    if (!frame) {
      if (!stream_.receive(Wait(0))) return std::nullopt;
      frame = stream_.next();
    }
    return frame ? std::optional(message_of(*frame)) : std::nullopt;
  }

  ToVehicle wait(Wait patience) { return message_of(wait_for_frame(patience)); }

  Frame wait_for_frame(Wait patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    for (;;) {
      if (const auto frame = stream_.next()) return *frame;
      if (interrupted_) throw LinkError(kStopped);
      if (!stream_.receive(kPiece) && std::chrono::steady_clock::now() > until)
        throw LinkError("the client has sent nothing for " + std::to_string(patience.count() / 1000) + " s");
    }
  }

  /// Sends all that is queued, however long the client computes.
  void send(Wait patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (!stream_.flush(kPiece)) {
      if (interrupted_) throw LinkError(kStopped);
      if (std::chrono::steady_clock::now() > until) throw LinkError("the client takes no more messages");
    }
  }

  /// A last word, if the client still listens.
  template <class M>
  void dismiss(const M& message, Wait patience = Wait(1000)) {
    stream_.queue(message);
    finish(patience);
  }
  /// What is not sent yet, if the client still listens.
  void finish(Wait patience) {
    try {
      stream_.flush(patience);
    } catch (const LinkError&) {
    }
  }

 private:
  static ToVehicle message_of(const Frame& frame) {
    std::string problem;
    std::optional<ToVehicle> message = read_message<ToVehicle>(frame, problem);
    if (!message) throw LinkError("the client sent what is no message: " + problem);
    return std::move(*message);
  }

  Stream& stream_;
  const std::atomic<bool>& interrupted_;
};

void obey(core::Vehicle& vehicle, const core::Command& c) {
  if (implausible(c).empty()) vehicle.command(c);
}

/// Clock and jobs are the client's until it is gone.
class LockstepService {
 public:
  LockstepService(Client& client, core::Vehicle& vehicle, const ServeOptions& options)
      : client_(client),
        vehicle_(vehicle),
        patience_(options.lockstep_patience),
        executive_(options.threads, client.stream()),
        sink_(client.stream(), vehicle.description(), [this] { pause(); }) {}

  std::string run() {
    std::string ending;
    try {
      vehicle_.start(executive_, sink_);
      if (const auto checks = vehicle_.checks(); !checks.empty()) client_.stream().queue(Checks{checks});
      done();
      while (ending.empty()) ending = answer(client_.wait(patience_));
    } catch (const LinkError& e) {
      ending = e.what();
    }
    if (!gone_.empty()) ending = gone_;
    client_.dismiss(Bye{ending});
    come_down();
    return ending;
  }

 private:
  void done() {
    if (!gone_.empty()) throw LinkError(gone_);
    client_.stream().queue(Done{executive_.now()});
    client_.send(patience_);
  }

  /// Why it is over; "" if it is not.
  std::string answer(const ToVehicle& message) {
    if (const auto* command = std::get_if<core::Command>(&message)) {
      obey(vehicle_, *command);
    } else if (const auto* run = std::get_if<Run>(&message)) {
      if (!executive_.run(run->slot, run->time)) return "the client asked for a slot that is not due next";
      done();
    } else if (const auto* ping = std::get_if<Ping>(&message)) {
      client_.stream().queue(Pong{ping->sent, executive_.now(), executive_.now()});
      client_.send(patience_);
    } else if (const auto* bye = std::get_if<Bye>(&message)) {
      return "the client left: " + bye->reason;
    } else {
      return "the client sent a message that has no place there";
    }
    return "";
  }

  /// Within a step of the vehicle: a client that is gone must not keep it from its end.
  void pause() {
    if (!gone_.empty()) return;
    try {
      client_.stream().queue(Pause{});
      client_.send(patience_);
      for (;;) {
        const ToVehicle message = client_.wait(patience_);
        if (std::holds_alternative<Resume>(message)) return;
        const auto* command = std::get_if<core::Command>(&message);
        if (!command) throw LinkError("the client sent a message that has no place there");
        obey(vehicle_, *command);
      }
    } catch (const LinkError& e) {
      gone_ = e.what();
    }
  }

  void come_down() {
    sink_.mute();
    executive_.mute();
    // run_until asks after each slot: a vehicle that is down already gets none that it would not have in
    // process.
    if (!sink_.down())
      executive_.run_until(executive_.now() + kComesDownWithin, [this] { return sink_.down(); });
    executive_.drain();
  }

  Client& client_;
  core::Vehicle& vehicle_;
  Wait patience_;
  MirroredExecutive executive_;
  SendingSink sink_;
  std::string gone_;  // noticed in a pause
};

/// The vehicle flies by the machine's clock, whether the client keeps up or not.
class RealTimeService {
 public:
  RealTimeService(Client& client, core::Vehicle& vehicle, const ServeOptions& options,
                  const std::atomic<bool>& interrupted)
      : client_(client),
        vehicle_(vehicle),
        forget_client_(options.forget_client),
        interrupted_(interrupted),
        executive_(options.threads, core::Clock::real_time),
        sink_(client.stream(), vehicle.description()) {}

  std::string run() {
    vehicle_.start(executive_, sink_);
    client_.stream().queue(Done{executive_.now()});
    executive_.every("client", kReadPeriod, kReadPeriod, [this] { step(); });
    executive_.every("checks", kSecond, kSecond, [this] { tell_checks(); });
    tell_checks();
    executive_.run_until(std::numeric_limits<TimeNs>::max() / 2, [this] { return over(); });
    executive_.drain();
    client_.finish(Wait(1000));
    return ending_;
  }

 private:
  void step() {
    if (!ending_.empty()) return;
    if (interrupted_) return end(kStopped);
    try {
      for (std::size_t i = 0; i < kMessagesAtOnce && ending_.empty(); ++i) {
        const auto message = client_.poll();
        if (!message) break;
        heard_at_ = executive_.now();
        take(*message);
      }
      if (ending_.empty()) client_.stream().flush(Wait(0));
    } catch (const LinkError& e) {
      return end(e.what());
    }
    if (ending_.empty() && executive_.now() - heard_at_ > forget_client_)
      end("the client has sent nothing for " + std::to_string(forget_client_ / kSecond) + " s");
  }

  void take(const ToVehicle& message) {
    if (const auto* command = std::get_if<core::Command>(&message)) return obey(vehicle_, *command);
    if (const auto* bye = std::get_if<Bye>(&message)) return end("the client left: " + bye->reason);
    const auto* ping = std::get_if<Ping>(&message);
    if (!ping) throw LinkError("the client sent a message that has no place there");
    const TimeNs now = executive_.measured_now();
    if (!full()) client_.stream().queue(Pong{ping->sent, now, executive_.measured_now()});
  }

  void tell_checks() {
    if (!ending_.empty() || full()) return;
    if (const auto checks = vehicle_.checks(); !checks.empty()) client_.stream().queue(Checks{checks});
  }

  /// A client that takes nothing for long gets no answers either.
  bool full() const { return client_.stream().backlog_bytes() >= kMaxToCoreBytes; }

  /// From now on it comes down by itself. Nothing waits for the client meanwhile: this is a step of the
  /// vehicle.
  void end(const std::string& why) {
    ending_ = why;
    ended_at_ = executive_.now();
    client_.dismiss(Bye{why}, Wait(0));
    sink_.mute();
  }
  bool over() const {
    if (ending_.empty()) return false;
    return sink_.down() || interrupted_ || executive_.now() - ended_at_ > kComesDownWithin;
  }

  Client& client_;
  core::Vehicle& vehicle_;
  TimeNs forget_client_;
  const std::atomic<bool>& interrupted_;
  core::Executive executive_;
  SendingSink sink_;
  TimeNs heard_at_ = 0, ended_at_ = 0;
  std::string ending_;  // "": not yet
};

/// The first six bytes of a greeting are the same in every version, so that another version can be told of.
Hello read_hello(const Frame& frame) {
  std::uint32_t magic = 0;
  std::uint16_t version = 0;
  if (frame.type != kType<Hello>.id || frame.body.size() < 6)
    throw LinkError("expected a greeting of the protocol of karst vehicles");
  std::memcpy(&magic, frame.body.data(), 4);
  std::memcpy(&version, frame.body.data() + 4, 2);
  if (magic != kMagic) throw LinkError("expected a greeting of the protocol of karst vehicles");
  if (version != kVersion)
    throw LinkError("this vehicle speaks version " + std::to_string(kVersion) +
                    " of the protocol, and the client " + std::to_string(version));
  std::string problem;
  const auto message = read_message<ToVehicle>(frame, problem);
  if (!message) throw LinkError(problem);
  const auto& hello = std::get<Hello>(*message);
  if (const std::string why = implausible(hello); !why.empty())
    throw LinkError("the greeting is wrong: " + why);
  return hello;
}

/// Whether the client starts the vehicle. Pings are answered before that, too.
void wait_for_start(Client& client, Wait patience) {
  for (;;) {
    const ToVehicle message = client.wait(patience);
    if (std::holds_alternative<Start>(message)) return;
    if (const auto* bye = std::get_if<Bye>(&message)) throw LinkError("the client left: " + bye->reason);
    const auto* ping = std::get_if<Ping>(&message);
    if (!ping) throw LinkError("the client sent a message that has no place there");
    client.stream().queue(Pong{ping->sent, 0, 0});
    client.send(patience);
  }
}

}  // namespace

Served serve_client(Stream& stream, const MakeVehicle& make, const ServeOptions& options,
                    const std::atomic<bool>& interrupted) {
  Client client(stream, interrupted);
  Served served;
  std::unique_ptr<core::Vehicle> vehicle;
  Hello hello;
  try {
    hello = read_hello(client.wait_for_frame(options.greeting_patience));
    vehicle = make(hello);
    stream.queue(Welcome{kMagic, kVersion, true, true, vehicle->description()});
    client.send(options.greeting_patience);
    wait_for_start(client, options.start_patience);
  } catch (const std::exception& e) {
    served.ending = e.what();
    client.dismiss(Refuse{served.ending});
    return served;
  }
  served.flew = true;
  served.ending = hello.clock == FlightClock::lockstep
                      ? LockstepService(client, *vehicle, options).run()
                      : RealTimeService(client, *vehicle, options, interrupted).run();
  vehicle->finish();
  return served;
}

Doorkeeper::Doorkeeper(Listener& listener)
    : thread_([&listener](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          std::optional<Stream> other = listener.accept(kPiece);
          if (!other) continue;
          try {
            other->queue(Refuse{"another client flies this vehicle"});
            other->flush(Wait(100));
            other->receive(kPiece);  // its greeting: closing with it unread could take the refusal away
          } catch (const LinkError&) {
          }
        }
      }) {}

}  // namespace karst::socket
