// The campaign's page, style and scripts, compiled in.
#pragma once
#include <string_view>
#include <vector>

namespace karst::campaign {

std::string_view campaign_template();
std::string_view campaign_style();
std::string_view plot_style();                     // of the plots on the page and of those saved as files
std::vector<std::string_view> campaign_scripts();  // in order of execution

}  // namespace karst::campaign
