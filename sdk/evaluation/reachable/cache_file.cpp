#include "sdk/evaluation/reachable/cache_file.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "core_stack/common/error.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::evaluation {

namespace fs = std::filesystem;

std::uint64_t word_sum(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
    hash = (hash ^ word) * 1099511628211ull;
    hash ^= hash >> 32;
  }
  return hash;
}

std::uint64_t word_sum(std::string_view text, std::uint64_t hash) {
  return word_sum(std::as_bytes(std::span(text)), (hash ^ text.size()) * 1099511628211ull);
}

void write_cache_file(const fs::path& file, std::string_view bytes) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  const fs::path own = file.string() + "." + std::to_string(getpid());  // other processes may write it, too
  try {
    write_whole_file(own, bytes);
    fs::rename(own, file, ignored);
    fs::remove(own, ignored);          // it still exists if renaming failed
  } catch (const core::InputError&) {  // a full disk
  }
}

}  // namespace karst::evaluation
