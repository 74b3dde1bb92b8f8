#include "tests/unit/evaluation/browser.h"

#include <cstdio>
#include <cstdlib>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::test {

std::string dom_in_browser(const std::filesystem::path& page, const std::string& hash) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) return "";
  TemporaryDirectory profile;
  const std::string command =
      "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync "
      "--disable-background-networking --disable-component-update --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --window-size=1400,1000 --virtual-time-budget=3000 --user-data-dir=" +
      profile.path().string() + " --dump-dom 'file://" + page.string() + (hash.empty() ? "" : "#" + hash) +
      "' 2>/dev/null";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string dom;
  char buffer[65536];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) dom.append(buffer, n);
  pclose(pipe);
  return dom;
}

}  // namespace karst::test
