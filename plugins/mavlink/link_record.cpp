#include "plugins/mavlink/link_record.h"

#include <fstream>

#include "core_stack/common/error.h"

namespace karst::mavlink {
namespace {

template <class... Message>
std::string find_name(std::uint32_t id, std::type_identity<std::tuple<Message...>>) {
  std::string found;
  ((id == Message::kId ? void(found = Message::kName) : void()), ...);
  return found;
}

void write_traffic(std::ofstream& out, const TrafficById& traffic, double duration_s) {
  std::uint64_t messages = 0, bytes = 0;
  out << "{\"messages\": {";
  const char* comma = "";
  for (const auto& [id, t] : traffic) {
    messages += t.messages, bytes += t.bytes;
    out << comma << "\n    \"" << find_name(id, std::type_identity<AllMessages>())
        << "\": {\"messages\": " << t.messages << ", \"bytes\": " << t.bytes << "}";
    comma = ",";
  }
  out << "},\n   \"messages_per_s\": " << static_cast<double>(messages) / duration_s
      << ", \"bytes_per_s\": " << static_cast<double>(bytes) / duration_s << "}";
}

}  // namespace

void write_link_record(const std::string& file, const Connection& c, const ClockSync& clock,
                       core::TimeNs duration) {
  std::ofstream out(file);
  const double duration_s = std::max(1e-3, core::seconds(duration));
  out << "{\"duration_s\": " << duration_s << ",\n \"sent\":\n  ";
  write_traffic(out, c.sent(), duration_s);
  out << ",\n \"received\":\n  ";
  write_traffic(out, c.received(), duration_s);
  out << ",\n \"lost_on_the_way_here\": " << c.loss().lost()
      << ", \"garbage_bytes\": " << c.parsed().garbage_bytes << ", \"from_others\": " << c.from_others()
      << ",\n \"round_trip_s\": " << core::seconds(clock.round_trip()) << "}\n";
  if (!out.flush()) throw core::InputError(file, "", "cannot be written: is the disk full?");
}

}  // namespace karst::mavlink
