// Files of a cave's cache: named by a sum of all that their content was computed from, and written by any of
// several processes at once.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace karst::evaluation {

/// FNV-1a over words of eight bytes, because meshes are large.
std::uint64_t word_sum(std::span<const std::byte> bytes, std::uint64_t hash = 14695981039346656037ull);
std::uint64_t word_sum(std::string_view text, std::uint64_t hash);

/// Writes the file, and its folder, completely or not at all. That it cannot be written is no error: what it
/// holds is computed again.
void write_cache_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace karst::evaluation
