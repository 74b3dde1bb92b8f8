// ROS 2 messages as bytes: the Common Data Representation, little-endian (OMG DDSI-RTPS 2.3, 10.2; CDR of
// CORBA 3.0, 15.3). A message is a struct with members(), a tuple of its members by name.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core_stack/common/little_endian.h"

namespace karst::ros {

template <class Message, class T>
struct Field {
  const char* name;
  T Message::*member;
};
template <class Message, class T>
Field(const char*, T Message::*) -> Field<Message, T>;

template <class T>
concept Message = requires {
  T::kType;
  T::members();
};

/// Appends values to `bytes`. A number of n bytes begins at a multiple of n, counted from behind the four
/// bytes that name the representation.
class CdrWriter {
 public:
  /// Begins a message at the end of `bytes`, which outlives the writer.
  explicit CdrWriter(std::string& bytes) : bytes_(bytes) {
    bytes_.append({0, 1, 0, 0});  // CDR, little-endian; no options
    origin_ = bytes_.size();
  }

  void put(bool value) { put(static_cast<std::uint8_t>(value)); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    align(sizeof value);
    core::append_bytes(bytes_, value);
  }
  void put(const std::string& text) {  // counted with the zero byte at its end
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text.c_str(), text.size() + 1);
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& elements) {
    for (const T& element : elements) put(element);
  }
  template <class T>
  void put(const std::vector<T>& elements) {
    put(static_cast<std::uint32_t>(elements.size()));
    if constexpr (sizeof(T) == 1)
      bytes_.append(reinterpret_cast<const char*>(elements.data()), elements.size());
    else
      for (const T& element : elements) put(element);
  }
  template <Message M>
  void put(const M& message) {
    std::apply([&](const auto&... field) { (put(message.*field.member), ...); }, M::members());
  }

 private:
  void align(std::size_t size) { bytes_.append((size - (bytes_.size() - origin_) % size) % size, '\0'); }

  std::string& bytes_;
  std::size_t origin_;
};

template <Message M>
std::string cdr_of(const M& message) {
  std::string bytes;
  CdrWriter(bytes).put(message);
  return bytes;
}

}  // namespace karst::ros
