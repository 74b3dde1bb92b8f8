#include "sdk/survey/text_encoding.h"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>

namespace karst::survey {
namespace {

class Converter {
 public:
  explicit Converter(const std::string& encoding) : handle_(iconv_open("UTF-8", encoding.c_str())) {}
  ~Converter() {
    if (valid()) iconv_close(handle_);
  }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  bool valid() const { return handle_ != reinterpret_cast<iconv_t>(-1); }  // NOLINT: iconv's way
  /// Converts as much as it can, and removes that from `in`.
  void convert(std::string_view& in, std::string& out) {
    std::array<char, 256> buffer;
    char* from = const_cast<char*>(in.data());  // NOLINT: iconv's signature; it does not write
    std::size_t left = in.size();
    while (left > 0) {
      char* to = buffer.data();
      std::size_t room = buffer.size();
      const std::size_t result = iconv(handle_, &from, &left, &to, &room);
      out.append(buffer.data(), buffer.size() - room);
      if (result == static_cast<std::size_t>(-1) && errno != E2BIG) break;
    }
    in.remove_prefix(in.size() - left);
  }

 private:
  iconv_t handle_;
};

}  // namespace

std::optional<std::string> known_encoding(std::string_view declared) {
  std::string name;
  for (const char c : declared) name += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  if (name.starts_with("ISO-8859")) name.erase(3, 1);
  if (name == "UTF8") name = "UTF-8";
  constexpr std::array kKnown = {"UTF-8",     "ASCII",     "ISO8859-1", "ISO8859-2",
                                 "ISO8859-5", "ISO8859-7", "ISO8859-9", "ISO8859-15",
                                 "CP1250",    "CP1251",    "CP1252",    "CP1253"};
  if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) return std::nullopt;
  return name;
}

Decoded to_utf8(std::string_view bytes, const std::string& encoding) {
  Decoded decoded;
  if (std::all_of(bytes.begin(), bytes.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; })) {
    decoded.text = bytes;
    return decoded;
  }
  Converter converter(encoding);
  while (!bytes.empty()) {
    if (converter.valid()) converter.convert(bytes, decoded.text);
    if (bytes.empty()) break;
    decoded.text += '?';
    decoded.replaced = true;
    bytes.remove_prefix(1);
  }
  return decoded;
}

}  // namespace karst::survey
