// Messages with random numbers, for property tests.
#pragma once
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>

#include "plugins/socket/wire.h"

namespace karst::socket::testing {

/// Fills fields with values of all kinds: a visitor, as the encoder is.
class Filler {
 public:
  template <class T>
  void operator()(const char*, T& value) {
    fill(value);
  }

 private:
  template <class T>
  requires std::is_arithmetic_v<T>
  void fill(T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      const int kind = *rc::gen::inRange(0, 8);
      value = static_cast<T>(*rc::gen::inRange(-1000000, 1000000)) / 997;
      if (kind == 0) value = std::numeric_limits<T>::infinity();
      if (kind == 1) value = -0.0;
    } else if constexpr (std::is_same_v<T, int>) {
      value = *rc::gen::inRange(0, std::numeric_limits<int>::max());
    } else {
      value = *rc::gen::arbitrary<T>();
    }
  }
  template <core::NamedEnum E>
  void fill(E& value) {
    const auto names = names_of(E{});
    value = names[*rc::gen::inRange<std::size_t>(0, names.size())].value;
  }
  void fill(std::string& text) { text = *rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~')); }
  void fill(core::Vec3& v) {
    for (int i = 0; i < 3; ++i) fill(v[i]);
  }
  void fill(core::Vec3f& v) {
    for (int i = 0; i < 3; ++i) fill(v[i]);
  }
  void fill(core::Quat& q) {
    for (int i = 0; i < 4; ++i) fill(q.coeffs()[i]);
  }
  template <class T>
  void fill(std::vector<T>& all) {
    all.resize(*rc::gen::inRange<std::size_t>(0, 6));
    for (T& one : all) fill(one);
  }
  template <class T>
  void fill(std::vector<std::shared_ptr<const T>>& all) {
    all.resize(*rc::gen::inRange<std::size_t>(0, 4));
    for (auto& one : all) {
      T value;
      fill(value);
      one = std::make_shared<const T>(std::move(value));
    }
  }
  template <class T>
  void fill(std::shared_ptr<const T>& value) {
    value = nullptr;
    if (*rc::gen::arbitrary<bool>()) {
      T filled;
      fill(filled);
      value = std::make_shared<const T>(std::move(filled));
    }
  }
  template <class T>
  requires requires(T& t, Filler& f) { fields(t, f); }
  void fill(T& value) { fields(value, *this); }
};

template <class M>
M any_message() {
  M message{};
  Filler filler;
  fields(message, filler);
  return message;
}

template <class M>
std::string bytes_of(const M& message) {
  std::string bytes;
  append_message(bytes, message);
  return bytes;
}
inline Frame frame_of(const std::string& bytes) {
  std::uint16_t type = 0;
  std::memcpy(&type, bytes.data() + 4, 2);
  return {type, std::string_view(bytes).substr(kHeaderBytes)};
}

/// Calls `check` with a random message of each type of a variant.
template <class Variant, class Check, std::size_t... kIndex>
void for_each_type(Check check, std::index_sequence<kIndex...>) {
  (check(any_message<std::variant_alternative_t<kIndex, Variant>>()), ...);
}
template <class Variant, class Check>
void for_each_type(Check check) {
  for_each_type<Variant>(check, std::make_index_sequence<std::variant_size_v<Variant>>());
}

}  // namespace karst::socket::testing
