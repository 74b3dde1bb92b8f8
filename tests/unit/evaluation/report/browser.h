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
/// The same in a browser that draws nothing in 3D: in half the time, for what is said beside the view.
ShownPage show_texts(const std::filesystem::path& page, const std::string& hash = "");

/// The same page in a window of 360 x 740 pixels, first as it opens, then with everything unfolded. The texts
/// are empty if all is well: what is wider than the window (all that the reader would have to scroll sideways
/// for), and what is touched but smaller than 40 pixels in a direction.
struct PhoneLayout {
  std::string too_wide, too_small;
  std::string open;  // ids of the <details> that are open at first, separated by spaces
};
PhoneLayout lay_out_on_phone(const std::filesystem::path& page);

/// The titles of the cave's drawings, separated by "; ", in a window so many pixels wide: each is visible and
/// fills most of it. After a title stands what is wrong, such as its size; at the end "page of", if the
/// page is wider than the window; and ids that stand twice in the document.
std::string drawings_on(const std::filesystem::path& page, int width_px);

/// The page on paper, in the browser's own size of paper (letter) where the page asks for no other.
struct PrintedPages {
  int all = 0, a4_upright = 0, a4_wide = 0;
};
PrintedPages print_page(const std::filesystem::path& page);

/// What does not fit in a window 1240 pixels wide, separated by "; ": cards, and tables of robots and pairs,
/// with something wider than they are, and heads of tables with a word broken in two.
std::string cut_on_desktop(const std::filesystem::path& page);

}  // namespace karst::test
