#include "plugins/socket/vehicle_link.h"

#include "core_stack/common/error.h"
#include "core_stack/common/printable.h"
#include "plugins/socket/plausible.h"

namespace karst::socket {

VehicleLink::VehicleLink(const Address& address, const Hello& hello, Wait patience)
    : address_(address.text()), stream_(connect_to(address, patience, kMaxToCoreBytes)) {
  try {
    welcome_ = greet(hello, patience);
  } catch (const LinkError& e) {
    throw core::InputError(address_, "", e.what());
  }
}

/// Nothing of the welcome is believed before it was looked at.
Welcome VehicleLink::greet(const Hello& hello, Wait patience) {
  stream_.queue(hello);
  stream_.flush(patience);
  const auto frame = next_frame(patience);
  if (!frame) throw LinkError("connected, but it does not greet");
  std::string problem;
  std::optional<ToCore> answer = read_message<ToCore>(*frame, problem);
  if (!answer) throw LinkError("its greeting cannot be read: " + problem);
  if (const auto* refuse = std::get_if<Refuse>(&*answer))
    throw LinkError("the vehicle refuses: " + core::printable(refuse->reason));
  auto* welcome = std::get_if<Welcome>(&*answer);
  if (!welcome || welcome->magic != kMagic) throw LinkError("what answers there is no vehicle of karst");
  if (welcome->version != kVersion)
    throw LinkError("it speaks version " + std::to_string(welcome->version) +
                    " of the protocol, and this karst " + std::to_string(kVersion));
  if (hello.clock == FlightClock::lockstep && !welcome->lockstep)
    throw LinkError("this vehicle flies in real time only: fly with --real-time");
  if (hello.clock == FlightClock::real_time && !welcome->real_time)
    throw LinkError("this vehicle flies in lockstep only: fly without --real-time");
  if (const std::string why = implausible(welcome->description); !why.empty())
    throw LinkError("its description is wrong: " + core::printable(why));
  return std::move(*welcome);
}

std::optional<Frame> VehicleLink::next_frame(Wait patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    if (auto frame = stream_.next()) return frame;
    const auto left = std::chrono::duration_cast<Wait>(until - std::chrono::steady_clock::now());
    if (!stream_.receive(std::max(Wait(0), left))) return std::nullopt;
    heard_ = true;
  }
}

std::optional<Received> VehicleLink::receive_one(Wait patience) {
  const auto frame = next_frame(patience);
  if (!frame) return std::nullopt;
  std::string problem;
  std::optional<ToCore> message = read_message<ToCore>(*frame, problem);
  if (!message) throw LinkError("it sent what is no message: " + problem);
  if (const auto* bye = std::get_if<Bye>(&*message))
    throw LinkError("the vehicle left: " + core::printable(bye->reason));
  const std::string why = implausible(*message, description());
  if (why.empty()) return Received{std::move(message)};
  if (dropped_++ == 0) first_dropped_ = "message " + std::to_string(frame->type) + ": " + why;
  return Received{};
}

std::optional<ToCore> VehicleLink::receive(Wait patience) {
  while (auto received = receive_one(patience))
    if (received->message) return std::move(received->message);
  return std::nullopt;
}

core::VehicleCheck VehicleLink::plausibility() const {
  const std::string found =
      dropped_ == 0 ? "all" : std::to_string(dropped_) + " dropped, the first: " + first_dropped_;
  return {"plausible messages", "all", found, dropped_ == 0};
}

void VehicleLink::leave(const std::string& reason) {
  try {
    stream_.queue(Bye{reason});
    stream_.flush(Wait(1000));
  } catch (const LinkError&) {  // it has left before
  }
}

namespace {

struct Delivery {
  const core::VehicleDescription& vehicle;
  core::VehicleSink& sink;

  void operator()(const auto&) const {}
  void operator()(core::ImuSample& m) const { sink.on_imu(m); }
  void operator()(core::MagnetometerSample& m) const { sink.on_magnetometer(m); }
  void operator()(core::BarometerSample& m) const { sink.on_barometer(m); }
  void operator()(core::PoseSample& m) const { sink.on_pose(m); }
  void operator()(core::BatteryStatus& m) const { sink.on_battery(m); }
  void operator()(core::LidarScan& m) const {
    m.model = vehicle.lidar;
    sink.on_lidar(std::make_shared<const core::LidarScan>(std::move(m)));
  }
  void operator()(Depth& m) const {
    m.image.model = vehicle.cameras[m.camera];
    sink.on_depth(std::make_shared<const core::DepthImage>(std::move(m.image)));
  }
  void operator()(core::RgbFrame& m) const {
    m.model = vehicle.rgb;
    sink.on_rgb(std::make_shared<const core::RgbFrame>(std::move(m)));
  }
  void operator()(Objects& m) const {
    m.look.camera = m.camera == kRgbCamera
                        ? std::shared_ptr<const core::CameraModel>(vehicle.rgb, &vehicle.rgb->camera)
                        : vehicle.cameras[m.camera];
    sink.on_objects(m.look);
  }
  void operator()(Ground& m) const { sink.on_ground(m.stamp); }
  void operator()(LiftOff& m) const { sink.on_lift_off(m.stamp); }
  void operator()(AuthorityChange& m) const { sink.on_authority(m.stamp, m.who, core::printable(m.reason)); }
  void operator()(Lost& m) const { sink.on_lost(m.stamp, m.outcome, core::printable(m.reason)); }
};

}  // namespace

void deliver(ToCore message, const core::VehicleDescription& vehicle, core::VehicleSink& sink) {
  std::visit(Delivery{vehicle, sink}, message);
}

}  // namespace karst::socket
