#include "tests/unit/evaluation/report/browser.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::test {

ShownPage show_page(const std::filesystem::path& page, const std::string& hash) {
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
  const std::string root = dom.substr(0, dom.find("<head>"));
  EXPECT_NE(root.find("data-ready=\"yes\""), std::string::npos)
      << "chromium (.ci/packages-test) showed: " << root.substr(0, 500);
  EXPECT_EQ(root.find("data-errors"), std::string::npos) << root;
  const std::size_t body = dom.find("<body>");
  return {dom, body == std::string::npos ? "" : dom.substr(body, dom.find("id=\"data\"") - body)};
}

}  // namespace karst::test
