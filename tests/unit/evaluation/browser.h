// A page in a real browser.
#pragma once
#include <filesystem>
#include <string>

namespace karst::test {

/// The page's DOM after its scripts ran in headless chromium, or "" if there is none. `hash` is what follows
/// # in its address.
std::string dom_in_browser(const std::filesystem::path& page, const std::string& hash = "");

}  // namespace karst::test
