// What a shared object exports.
#pragma once
#include <string>
#include <vector>

namespace karst::check {

/// Names of its defined dynamic symbols that others may bind to. Throws core::InputError if the file is not a
/// 64-bit ELF file with a table of symbols.
std::vector<std::string> exported_symbols(const std::string& file);

}  // namespace karst::check
