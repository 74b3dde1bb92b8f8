#include "plugins/socket/wire.h"

namespace karst::socket {
namespace {

/// Reads it if the frame is an M; false if it is not.
template <class M, class Variant>
bool read_as(const Frame& frame, std::optional<Variant>& message, std::string& problem) {
  if (frame.type != kType<M>.id) return false;
  M value{};
  Reader reader(frame.body);
  fields(value, reader);
  const std::string name = kType<M>.name;
  if (!reader.problem().empty())
    problem = name + ": " + reader.problem() + " is cut off or not valid";
  else if (reader.left() > 0)
    problem = name + ": " + std::to_string(reader.left()) + " bytes too long";
  else
    message.emplace(std::move(value));
  return true;
}

template <class Variant, std::size_t... kIndex>
std::optional<Variant> read_any(const Frame& frame, std::string& problem, std::index_sequence<kIndex...>) {
  std::optional<Variant> message;
  const bool known = (read_as<std::variant_alternative_t<kIndex, Variant>>(frame, message, problem) || ...);
  if (!known) problem = "type " + std::to_string(frame.type) + ": there is no such message here";
  return message;
}

}  // namespace

template <class Variant>
std::optional<Variant> read_message(const Frame& frame, std::string& problem) {
  problem.clear();
  return read_any<Variant>(frame, problem, std::make_index_sequence<std::variant_size_v<Variant>>());
}
template std::optional<ToVehicle> read_message<ToVehicle>(const Frame&, std::string&);
template std::optional<ToCore> read_message<ToCore>(const Frame&, std::string&);

}  // namespace karst::socket
