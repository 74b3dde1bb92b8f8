// The page that follows a flight: one file, which needs nothing else.
#pragma once
#include <string_view>

namespace karst::live {

std::string_view live_page();

}  // namespace karst::live
