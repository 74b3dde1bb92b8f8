// Policies in files of a language with a run time of its own (sdk/abi/karst_abi_script.h).
#pragma once
#include <filesystem>
#include <string>

#include "sdk/abi/karst_abi.h"

namespace karst::host {

/// Whether the ending of the file's name is that of a language: anything but a shared object's.
bool is_script(const std::filesystem::path& file);

/// PREFIX/lib/karst, of the program that runs: there are the languages and what they need.
std::filesystem::path own_libraries();

/// Why there is no Python, and what to do.
std::string without_python();

/// Opens the file's language, and the file by it. Throws core::InputError with file, line and reason: no such
/// language, not a file, a fault in it, no policy in it.
const karst_plugin_t& enter_script(const std::string& path);

/// Whether a file in a folder of policies looks as if it held one. A folder may hold other files of the
/// language, such as the policies' tests: they are not run to find that out.
bool may_hold_policy(const std::filesystem::path& file);

}  // namespace karst::host
