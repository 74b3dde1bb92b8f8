// A page in a real browser.
#pragma once
#include <filesystem>
#include <string>

namespace karst::test {

/// The page after its scripts ran in headless chromium. Fails if chromium did not show it, or if the page had
/// an error or did not come to its end. `hash` is what follows # in its address.
struct ShownPage {
  std::string dom, body;  // whole, and the body up to the data
};
ShownPage show_page(const std::filesystem::path& page, const std::string& hash = "");

}  // namespace karst::test
