// Text of others on its way to a terminal, which obeys what it prints.
#pragma once
#include <string>
#include <string_view>

namespace karst::core {

/// `text` with '?' for each control character but newline and tab (C0, DEL, C1), for each character that
/// turns the direction of the text (Unicode's Bidi_Control, with which a name can show as another), and for
/// each byte that is no UTF-8.
std::string printable(std::string_view text);

}  // namespace karst::core
