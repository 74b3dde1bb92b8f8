#include "core_stack/team/communication/mission_key.h"

#include <sodium.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::core {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 4096;

/// libsodium may choose its fastest implementation only once; all give the same bytes.
void be_ready() {
  static const bool ready = sodium_init() >= 0;
  if (!ready) throw std::runtime_error("libsodium cannot be used: the system gives it no random numbers");
}

}  // namespace

MissionKey key_of_seed(std::uint64_t seed) {
  be_ready();
  constexpr std::string_view purpose = "karst: key of a simulated mission";
  Bytes text(purpose.begin(), purpose.end());
  WireWriter(text).number(seed, 8);
  MissionKey key;
  crypto_generichash(key.bytes.data(), key.bytes.size(), text.data(), text.size(), nullptr, 0);
  return key;
}

MissionKey read_key(const std::string& file) {
  const std::string text = read_input(file, kMaxFileBytes);
  MissionKey key;
  std::size_t length = 0;
  const char* end = nullptr;
  const int failed =
      sodium_hex2bin(key.bytes.data(), key.bytes.size(), text.data(), text.size(), " \t\r\n", &length, &end);
  if (failed != 0 || length != key.bytes.size() || end != text.data() + text.size())
    throw InputError(file, "", "expected a key: 64 hexadecimal digits, and nothing else but white space");
  if (std::all_of(key.bytes.begin(), key.bytes.end(), [&](std::uint8_t b) { return b == key.bytes[0]; }))
    throw InputError(file, "", "one byte over and over is no key: take one from a random generator");
  return key;
}

Tag tag_of(std::span<const std::uint8_t> bytes, const MissionKey& key) {
  be_ready();
  std::array<std::uint8_t, crypto_generichash_BYTES_MIN> hash{};
  crypto_generichash(hash.data(), hash.size(), bytes.data(), bytes.size(), key.bytes.data(),
                     key.bytes.size());
  Tag tag{};
  std::copy_n(hash.begin(), tag.size(), tag.begin());
  return tag;
}

bool has_tag(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> tag, const MissionKey& key) {
  const Tag expected = tag_of(bytes, key);
  return tag.size() == expected.size() && sodium_memcmp(tag.data(), expected.data(), expected.size()) == 0;
}

}  // namespace karst::core
