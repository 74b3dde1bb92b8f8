#include "sdk/campaign/plan/hash.h"

#include <sha2.h>

#include <array>
#include <fstream>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::campaign {
namespace {

std::string hex_of(SHA2_CTX& context) {
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest;
  SHA256Final(digest.data(), &context);
  std::string hex;
  for (const std::uint8_t b : digest) {
    hex += "0123456789abcdef"[b >> 4];
    hex += "0123456789abcdef"[b & 15];
  }
  return hex;
}

}  // namespace

std::string sha256(std::string_view bytes) {
  SHA2_CTX context;
  SHA256Init(&context);
  SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  return hex_of(context);
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream in = core::open_input(file, core::kMaxDataFileBytes);
  SHA2_CTX context;
  SHA256Init(&context);
  std::vector<char> block(1 << 20);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(block.data()),
                 static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw core::InputError(file.string(), "", "cannot be read");
  return hex_of(context);
}

}  // namespace karst::campaign
