// Frames of all messages for another implementation of MAVLink to read, and its frames read here.
//   mavlink_interop write   "NAME HEX JSON" of each message, with fields of all sizes
//   mavlink_interop read    "HEX" lines from the standard input, as "NAME JSON"
#include <cstdio>
#include <iostream>
#include <string>

#include "core_stack/common/random.h"
#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {
namespace {

template <class T>
void fill(T& value, core::Random& random) {
  if constexpr (std::is_same_v<T, float>)
    value = static_cast<float>(random.uniform(-1000, 1000));
  else if constexpr (std::is_same_v<T, char>)
    value = static_cast<char>('A' + random.bits() % 26);
  else
    value = static_cast<T>(random.bits());
}
template <class T, std::size_t N>
void fill(std::array<T, N>& values, core::Random& random) {
  for (T& v : values) fill(v, random);
}

template <class T>
std::string text(const T& value) {
  char out[60];
  if constexpr (std::is_same_v<T, float>)
    std::snprintf(out, sizeof out, "%.9g", static_cast<double>(value));
  else if constexpr (sizeof(T) == 8)
    return '"' + std::to_string(value) + '"';
  else
    return std::to_string(value);
  return out;
}
template <std::size_t N>
std::string text(const std::array<char, N>& value) {
  return '"' + std::string(value.begin(), std::find(value.begin(), value.end(), '\0')) + '"';
}
template <class T, std::size_t N>
std::string text(const std::array<T, N>& values) {
  std::string out = "[";
  for (const T& v : values) out += (out.size() > 1 ? "," : "") + text(v);
  return out + "]";
}

template <class Message>
std::string json(const Message& m) {
  std::string out = "{";
  std::apply(
      [&](const auto&... f) {
        ((out += (out.size() > 1 ? ",\"" : "\"") + std::string(f.name) + "\":" + text(m.*(f.member))), ...);
      },
      Message::fields());
  return out + "}";
}

template <class Message>
void write_one(core::Random& random) {
  for (int variant = 0; variant < 3; ++variant) {
    Message m;
    // The last variant is all zeros but for its first field: a truncated payload.
    int left = variant == 2 ? 1 : 1000;
    std::apply(
        [&](const auto&... f) {
          ((left-- > 0 ? fill(m.*(f.member), random) : void(m.*(f.member) = {})), ...);
        },
        Message::fields());
    Frame frame = frame_of(m, {7, 42});
    frame.sequence = static_cast<std::uint8_t>(random.bits());
    std::printf("%s ", std::string(Message::kName).c_str());
    for (const std::uint8_t b : to_wire(frame)) std::printf("%02x", b);
    std::printf(" %s\n", json(m).c_str());
  }
}

template <class Message>
void read_one(const Frame& frame) {
  if (frame.is<Message>())
    std::printf("%s %s\n", std::string(Message::kName).c_str(), json(frame.as<Message>()).c_str());
}

template <class... Message>
void write_all(std::type_identity<std::tuple<Message...>>) {
  core::Random random(20261126);
  (write_one<Message>(random), ...);
}
template <class... Message>
void read_as(const Frame& frame, std::type_identity<std::tuple<Message...>>) {
  (read_one<Message>(frame), ...);
}

}  // namespace
}  // namespace karst::mavlink

int main(int argc, char** argv) {
  using namespace karst::mavlink;
  const std::type_identity<AllMessages> all;
  if (argc == 2 && std::string(argv[1]) == "write") {
    write_all(all);
    return 0;
  }
  FrameParser parser;
  for (std::string line; std::getline(std::cin, line);) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2)
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(line.substr(i, 2), nullptr, 16)));
    parser.add(bytes);
    while (const auto frame = parser.next()) read_as(*frame, all);
  }
  return parser.counts().garbage_bytes == 0 ? 0 : 1;
}
