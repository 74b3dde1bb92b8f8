// The exported symbols of a shared object.
#pragma once
#include <string>
#include <vector>

namespace karst::check {

/// Names of its defined dynamic symbols with external binding. Throws core::InputError if the file is not a
/// 64-bit ELF file with a symbol table.
std::vector<std::string> exported_symbols(const std::string& file);

}  // namespace karst::check
