// The state that a policy keeps from one decision to the next, so that it survives a crash: a policy that
// also derives from karst::Restorable lists its fields once, and the host saves and restores them
// (karst_abi_state.h). A policy that does not derive from it is restarted without its state.
//
//   class Wanderer : public karst::Policy, public karst::Restorable {
//     void memory(karst::Memory& m) override { m.add(visited_), m.add(turns_); }
//     std::vector<karst::Vec3> visited_;
//     int turns_ = 0;
//   };
#pragma once
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <karst/types.h>

namespace karst {

/// Reads or writes every field that is added, in the order of the calls: the same function does both. Takes
/// plain values and structs of them, strings, vectors, maps, sets, pairs, optionals, and every type with a
/// member `void memory(karst::Memory&)`. It takes no pointers and no structs that hold pointers (MapView,
/// Sensor), which are meaningless in another process.
class Memory {
 public:
  Memory() = default;  // writes
  /// Reads bytes that sealed() returned. Throws Error if they fail the checksum.
  Memory(const void* bytes, std::uint64_t count)
      : reading_(true),
        bytes_(static_cast<const unsigned char*>(bytes), static_cast<const unsigned char*>(bytes) + count) {
    std::uint64_t seal = 0;
    if (count < sizeof seal) cut_short();
    std::memcpy(&seal, bytes_.data() + count - sizeof seal, sizeof seal);
    bytes_.resize(count - sizeof seal);
    if (seal != checksum(bytes_)) cut_short();
  }

  bool reading() const { return reading_; }  // true while restoring
  /// The written bytes, followed by a checksum.
  std::vector<unsigned char> sealed() const {
    std::vector<unsigned char> out(bytes_);
    const std::uint64_t seal = checksum(bytes_);
    out.resize(bytes_.size() + sizeof seal);
    std::memcpy(out.data() + bytes_.size(), &seal, sizeof seal);
    return out;
  }

  template <class T>
  void add(T& field) {
    static_assert(!std::is_pointer_v<T>, "a pointer cannot be restored: remember an index, an id or a place");
    if constexpr (has_memory<T>(0))
      field.memory(*this);
    else
      plain(field);
  }
  void add(bool& flag) {
    std::uint8_t byte = flag ? 1 : 0;
    plain(byte);
    flag = byte != 0;
  }
  void add(std::string& text) { elements(text); }
  template <class T>
  void add(std::vector<T>& list) {
    if constexpr (std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool> && !has_memory<T>(0))
      elements(list);
    else
      collection<T>(list, [&](T&& v) { list.push_back(std::move(v)); });
  }
  template <class K, class V>
  void add(std::map<K, V>& map) {
    collection<std::pair<K, V>>(map, [&](std::pair<K, V>&& v) { map.insert(std::move(v)); });
  }
  template <class T>
  void add(std::set<T>& set) {
    collection<T>(set, [&](T&& v) { set.insert(std::move(v)); });
  }
  template <class A, class B>
  void add(std::pair<A, B>& pair) {
    add(pair.first);
    add(pair.second);
  }
  template <class T>
  void add(std::optional<T>& value) {
    bool there = value.has_value();
    add(there);
    if (reading_) value = there ? std::optional<T>(T{}) : std::nullopt;
    if (there) add(*value);
  }

  /// Throws Error if bytes are left over, because another version wrote them.
  void done() const {
    if (at_ != bytes_.size())
      throw Error("the saved state is longer than this policy's", KARST_ERROR_ARGUMENT);
  }

 private:
  /// FNV-1a.
  static std::uint64_t checksum(const std::vector<unsigned char>& bytes) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const unsigned char b : bytes) hash = (hash ^ b) * 1099511628211ull;
    return hash;
  }

  template <class T>
  static constexpr auto has_memory(int)
      -> decltype(std::declval<T&>().memory(std::declval<Memory&>()), true) {
    return true;
  }
  template <class T>
  static constexpr bool has_memory(...) {
    return false;
  }

  template <class T>
  void plain(T& field) {
    static_assert(std::is_trivially_copyable_v<T>,
                  "give this type a member void memory(karst::Memory&), or remember its parts");
    copy(&field, sizeof field);
  }
  /// Rejects a length beyond the bytes left, before anything of that length is allocated.
  std::uint64_t length(std::uint64_t now, std::size_t element_bytes) {
    plain(now);
    if (reading_ && now > (bytes_.size() - at_) / element_bytes) cut_short();
    return now;
  }
  /// Strings, and lists of plain values.
  template <class List>
  void elements(List& list) {
    const std::uint64_t count = length(list.size(), sizeof(typename List::value_type));
    if (reading_) list.resize(count);
    if (count > 0) copy(list.data(), count * sizeof(typename List::value_type));
  }
  template <class T, class Collection, class Insert>
  void collection(Collection& all, Insert&& insert) {
    const std::uint64_t count = length(all.size(), 1);
    if (!reading_) {
      for (const auto& v : all) {
        T copy(v);
        add(copy);
      }
      return;
    }
    all.clear();
    for (std::uint64_t i = 0; i < count; ++i) {
      T v{};
      add(v);
      insert(std::move(v));
    }
  }
  void copy(void* field, std::size_t count) {
    if (!reading_) {
      bytes_.resize(at_ + count);
      std::memcpy(bytes_.data() + at_, field, count);
    } else if (count > bytes_.size() - at_) {
      cut_short();
    } else {
      std::memcpy(field, bytes_.data() + at_, count);
    }
    at_ += count;
  }
  [[noreturn]] static void cut_short() {
    throw Error("the saved state is cut short or damaged", KARST_ERROR_ARGUMENT);
  }

  bool reading_ = false;
  std::vector<unsigned char> bytes_;
  std::size_t at_ = 0;
};

/// Derive from it, in addition to Policy, to keep the policy's state over a restart.
class Restorable {
 public:
  virtual ~Restorable() = default;
  /// Adds every field that a decision depends on, except parameters. Called after init() to restore, and
  /// between two other calls to save. Throw karst::Error if the values read are not consistent.
  virtual void memory(Memory& memory) = 0;
};

}  // namespace karst
