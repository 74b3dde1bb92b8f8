// Whether Survex files include each other in a circle: cavern 1.4.4 then crashes, and says nothing.
#pragma once
#include <string>

namespace karst::survey {

/// Follows the `*include` of a .svx file, as cavern finds them: beside the file, with or without ".svx", also
/// in small letters. Files that cannot be read are passed over; cavern says of them what is wrong. Commands
/// that `*set` gave another character are not seen. Throws core::InputError naming the file and the line that
/// includes a file that is being read already.
void refuse_include_cycles(const std::string& file);

}  // namespace karst::survey
