// Opening what a user names, for writing.
#pragma once
#include <fstream>
#include <string>

namespace karst::core {

/// A binary stream into `file`, emptied. A FIFO that nobody reads would block: throws InputError instead, and
/// where the file cannot be made.
std::ofstream open_output(const std::string& file);

}  // namespace karst::core
