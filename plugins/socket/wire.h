// Messages as bytes: a header of the body's length (u32), the type (u16) and two bytes of zero, then the
// fields one after another, little-endian, without padding. docs/vehicle_protocol.json lists them all.
#pragma once
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/little_endian.h"
#include "plugins/socket/fields.h"

namespace karst::socket {

constexpr std::size_t kHeaderBytes = 8;
constexpr std::uint32_t kMaxToVehicleBytes = 64 * 1024, kMaxToCoreBytes = 64 * 1024 * 1024;  // of a body
constexpr std::size_t kMaxTextBytes = 4096;

/// Appends fields to `bytes`.
class Writer {
 public:
  explicit Writer(std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(const char*, const T& value) {
    put(value);
  }

 private:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    if constexpr (std::is_same_v<T, bool>)
      core::append_bytes(bytes_, static_cast<std::uint8_t>(value));
    else if constexpr (std::is_same_v<T, int>)
      core::append_bytes(bytes_, static_cast<std::uint32_t>(value));
    else
      core::append_bytes(bytes_, value);
  }
  template <core::NamedEnum E>
  void put(E value) {
    core::append_bytes(bytes_, static_cast<std::uint8_t>(value));
  }
  void put(const std::string& text) {
    const auto size = static_cast<std::uint16_t>(std::min(text.size(), kMaxTextBytes));
    core::append_bytes(bytes_, size);
    bytes_.append(text, 0, size);
  }
  void put(const core::Vec3& p) {
    for (int i = 0; i < 3; ++i) put(p[i]);
  }
  void put(const core::Vec3f& p) {
    bytes_.append(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float));
  }
  void put(const core::Quat& q) {
    for (int i = 0; i < 4; ++i) put(q.coeffs()[i]);  // x y z w
  }
  template <class T>
  void put(const std::vector<T>& all) {
    core::append_bytes(bytes_, static_cast<std::uint32_t>(all.size()));
    if constexpr (std::is_arithmetic_v<T>)
      bytes_.append(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(T));
    else
      for (const T& one : all) put(one);
  }
  template <class T>
  void put(const std::shared_ptr<T>& value) {  // one byte that says whether it is there
    put(value != nullptr);
    if (value) put(*value);
  }
  template <class T>
  void put(const std::vector<std::shared_ptr<T>>& all) {
    core::append_bytes(bytes_, static_cast<std::uint32_t>(all.size()));
    for (const auto& one : all) put(*one);
  }
  template <class T>
  requires requires(const T& t, Writer& w) { fields(t, w); }
  void put(const T& value) { fields(value, *this); }

  std::string& bytes_;
};

/// Reads fields from `bytes`. After a field that is not there or not valid, ok() is false and nothing more is
/// read.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(const char* name, T& value) {
    if (!problem_.empty()) return;
    if (!get(value) && problem_.empty()) problem_ = name;
  }
  /// The field that could not be read; "" if all were.
  const std::string& problem() const { return problem_; }
  std::size_t left() const { return bytes_.size(); }

 private:
  bool take(void* to, std::size_t size) {
    if (bytes_.size() < size) return false;
    std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return true;
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  bool get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      if (!take(&byte, 1) || byte > 1) return false;
      value = byte != 0;
    } else if constexpr (std::is_same_v<T, int>) {
      std::uint32_t number = 0;
      if (!take(&number, 4) || number > std::numeric_limits<int>::max()) return false;
      value = static_cast<int>(number);
    } else {
      return take(&value, sizeof value);
    }
    return true;
  }
  template <core::NamedEnum E>
  bool get(E& value) {
    std::uint8_t number = 0;
    if (!take(&number, 1)) return false;
    value = static_cast<E>(number);
    for (const auto& named : names_of(E{}))
      if (named.value == value) return true;
    return false;
  }
  bool get(std::string& text) {
    std::uint16_t size = 0;
    if (!take(&size, 2) || size > kMaxTextBytes || size > bytes_.size()) return false;
    text.assign(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return true;
  }
  bool get(core::Vec3& p) { return take(p.data(), 3 * sizeof(double)); }
  bool get(core::Vec3f& p) { return take(p.data(), 3 * sizeof(float)); }
  bool get(core::Quat& q) { return take(q.coeffs().data(), 4 * sizeof(double)); }
  /// The count comes first: nothing is allocated for elements that cannot be there.
  template <class T, class Element>
  bool get_all(std::vector<T>& all, const Element& element, std::size_t least_bytes) {
    std::uint32_t count = 0;
    if (!take(&count, 4) || count > bytes_.size() / least_bytes) return false;
    all.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      all.emplace_back();
      if (!element(all.back())) return false;
    }
    return true;
  }
  template <class T>
  bool get(std::vector<T>& all) {
    if constexpr (std::is_arithmetic_v<T>) {
      std::uint32_t count = 0;
      if (!take(&count, 4) || count > bytes_.size() / sizeof(T)) return false;
      all.resize(count);
      return count == 0 || take(all.data(), count * sizeof(T));
    } else {
      return get_all(
          all, [this](T& one) { return get(one); }, 1);
    }
  }
  template <class T>
  bool get(std::vector<std::shared_ptr<const T>>& all) {
    return get_all(
        all,
        [this](std::shared_ptr<const T>& one) {
          T value;
          if (!get(value)) return false;
          one = std::make_shared<const T>(std::move(value));
          return true;
        },
        1);
  }
  template <class T>
  bool get(std::shared_ptr<const T>& value) {
    bool there = false;
    if (!get(there)) return false;
    value = nullptr;
    if (!there) return true;
    T read;
    if (!get(read)) return false;
    value = std::make_shared<const T>(std::move(read));
    return true;
  }
  template <class T>
  requires requires(T& t, Reader& r) { fields(t, r); }
  bool get(T& value) {
    fields(value, *this);
    return problem_.empty();
  }

  std::string_view bytes_;
  std::string problem_;
};

/// Appends a whole message, header and body, to `bytes`.
template <class M>
void append_message(std::string& bytes, const M& message) {
  const std::size_t begin = bytes.size();
  core::append_bytes(bytes, std::uint32_t{0});
  core::append_bytes(bytes, kType<M>.id);
  core::append_bytes(bytes, std::uint16_t{0});
  Writer writer(bytes);
  fields(message, writer);
  const auto size = static_cast<std::uint32_t>(bytes.size() - begin - kHeaderBytes);
  std::memcpy(bytes.data() + begin, &size, sizeof size);
}

/// A message's type and body, as it came.
struct Frame {
  std::uint16_t type = 0;
  std::string_view body;
};

/// Reads one message of the variant's types. Returns nothing, and says why, if it is none of them, or its
/// body is shorter or longer than its fields, or a value is not valid. `plausible.h` checks what the numbers
/// mean.
template <class Variant>
std::optional<Variant> read_message(const Frame& frame, std::string& problem);
extern template std::optional<ToVehicle> read_message<ToVehicle>(const Frame&, std::string&);
extern template std::optional<ToCore> read_message<ToCore>(const Frame&, std::string&);

}  // namespace karst::socket
