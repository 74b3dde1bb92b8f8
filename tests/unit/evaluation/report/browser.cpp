#include "tests/unit/evaluation/report/browser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/unit/evaluation/fake_run.h"

namespace karst::test {
namespace {

constexpr const char* kChromium =
    "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync "
    "--disable-background-networking --disable-component-update --window-size=1400,1000 "
    "--virtual-time-budget=3000 ";
/// To draw the view in 3D by software takes as long as all else.
constexpr const char* kDrawn = "--use-angle=swiftshader --enable-unsafe-swiftshader ";
constexpr const char* kTexts = "--disable-3d-apis ";

ShownPage dumped(const std::filesystem::path& page, const std::string& hash, const std::string& options) {
  TemporaryDirectory profile;
  const std::string command = kChromium + options + " --user-data-dir=" + profile.path().string() +
                              " --dump-dom 'file://" + page.string() + (hash.empty() ? "" : "#" + hash) +
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

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// As the value of an attribute.
std::string quoted_page(const std::string& page) {
  std::string quoted;
  for (const char c : page) {
    if (c == '&') {
      quoted += "&amp;";
    } else if (c == '"') {
      quoted += "&quot;";
    } else {
      quoted += c;
    }
  }
  return quoted;
}

/// The page in a frame of width x height pixels, and a script that runs `measure` once the page is ready,
/// with `page`, its document, `root`, that document's element, and put(id, texts), which writes down what it
/// found. The frame's document stands in an attribute: a page from a file may not look into another one.
std::string measured_frame(const std::string& page, int width, int height, const std::string& measure) {
  return R"html(<!doctype html><html><head><meta charset="utf-8"><title>frame</title></head><body>
<script>
async function measureFrame(frame) {
  const page = frame.contentDocument, root = page.documentElement;
  for (let i = 0; i < 100 && !root.dataset.ready; ++i) await new Promise((go) => setTimeout(go, 20));
  const put = (id, texts) => {
    const p = document.createElement("p");
    p.id = id;
    p.textContent = [...new Set(texts)].join("; ");
    document.body.append(p);
  };
  const name = (e) => e.tagName.toLowerCase() + (e.id ? "#" + e.id : e.className ? "." + e.className : "");
)html" + measure +
         R"html(
  if (root.dataset.errors) document.documentElement.dataset.errors = root.dataset.errors;
  document.documentElement.dataset.ready = root.dataset.ready || "no";
  frame.remove();
}
</script>
<iframe onload="measureFrame(this)" style="border: 0; width: )html" +
         std::to_string(width) + "px; height: " + std::to_string(height) + R"html(px" srcdoc=")html" +
         quoted_page(page) + R"html("></iframe></body></html>
)html";
}

/// What is cut off, or broken within a word, in a window of 1240 x 900 pixels.
std::string desktop_frame(const std::string& page) {
  return measured_frame(page, 1240, 900, R"html(
  const cut = [], told = (e) => e.tagName.toLowerCase() + " " + e.textContent.slice(0, 40);
  for (const e of page.querySelectorAll(".figure, .scroll:has(#robot-table), .card:has(> #pair-table)"))
    if (e.checkVisibility() && e.scrollWidth > e.clientWidth) cut.push(told(e));
  for (const e of page.querySelectorAll("th")) {
    if (!e.checkVisibility() || !e.textContent.trim()) continue;
    const tops = new Set(), range = page.createRange(), texts = page.createTreeWalker(e, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
      range.selectNodeContents(texts.currentNode);
      for (const r of range.getClientRects()) tops.add(Math.round(r.top));
    }
    if (tops.size > e.textContent.trim().split(/[\s-]+/).length) cut.push(told(e));
  }
  put("cut", cut);)html");
}

/// What is too wide, and what too small for a thumb, on a phone, whose size chromium's own window cannot
/// have.
std::string phone_frame(const std::string& page) {
  return measured_frame(page, 360, 740, R"html(
  const size = (e) => { const r = e.getBoundingClientRect(); return name(e) + " " + r.width + " x " + r.height; };
  const wide = [], small = [];
  const measure = () => {
    if (root.scrollWidth > 360)
      wide.push("page of " + root.scrollWidth, ...[...page.querySelectorAll("body *")]
        .filter((e) => e.getBoundingClientRect().right > 360.5).slice(0, 12).map(size));
    for (const e of page.querySelectorAll("button, select, summary, label, input[type=range]")) {
      const r = e.getBoundingClientRect();
      if (e.checkVisibility() && r.width && (r.width < 39.9 || r.height < 39.9)) small.push(size(e));
    }
  };
  put("open", [[...page.querySelectorAll("details[open]")].map((d) => d.id).filter(Boolean).join(" ")]);
  measure();
  for (const d of page.querySelectorAll("details")) d.open = true;
  measure();
  put("wide", wide);
  put("small", small);)html");
}

std::string drawings_frame(const std::string& page, int width_px) {
  return measured_frame(page, width_px, 740, R"html(
  const told = [], ids = new Map();
  for (const f of page.querySelectorAll("#cave-drawings figure")) {
    const svg = f.querySelector("svg.cave-drawing"), r = (svg || f).getBoundingClientRect();
    const fits = svg && svg.checkVisibility() && svg.querySelector("path, polyline, polygon, line") &&
                 r.left >= 0 && r.right <= frame.clientWidth && r.width > 0.8 * frame.clientWidth &&
                 r.height > 0.5 * r.width;
    told.push(f.querySelector("figcaption").textContent + (fits ? "" : " " + r.width + " x " + r.height));
  }
  if (root.scrollWidth > frame.clientWidth) told.push("page of " + root.scrollWidth);
  for (const e of page.querySelectorAll("[id]")) ids.set(e.id, (ids.get(e.id) || 0) + 1);
  for (const [id, count] of ids) if (count > 1) told.push("twice: " + id);
  put("drawings", told);)html");
}

std::string text_of(const std::string& dom, const std::string& id) {
  const std::string mark = "<p id=\"" + id + "\">";
  const std::size_t at = dom.find(mark);
  EXPECT_NE(at, std::string::npos) << "the page was not measured";
  if (at == std::string::npos) return "not measured";
  const std::size_t begin = at + mark.size();
  return dom.substr(begin, dom.find("</p>", begin) - begin);
}

}  // namespace

ShownPage show_page(const std::filesystem::path& page, const std::string& hash) {
  return dumped(page, hash, kDrawn);
}

ShownPage show_texts(const std::filesystem::path& page, const std::string& hash) {
  return dumped(page, hash, kTexts);
}

PhoneLayout lay_out_on_phone(const std::filesystem::path& page) {
  const TemporaryDirectory dir;
  dir.write("phone.html", phone_frame(bytes_of(page)));
  const std::string dom =
      dumped(dir.path() / "phone.html", "", std::string(kDrawn) + "--allow-file-access-from-files").dom;
  return {text_of(dom, "wide"), text_of(dom, "small"), text_of(dom, "open")};
}

std::string drawings_on(const std::filesystem::path& page, int width_px) {
  const TemporaryDirectory dir;
  dir.write("drawings.html", drawings_frame(bytes_of(page), width_px));
  const std::string options = std::string(kTexts) + "--allow-file-access-from-files";
  return text_of(dumped(dir.path() / "drawings.html", "", options).dom, "drawings");
}

PrintedPages print_page(const std::filesystem::path& page) {
  const TemporaryDirectory dir;
  const std::filesystem::path pdf = dir.path() / "page.pdf";
  const std::string command =
      std::string(kChromium) + kTexts + "--user-data-dir=" + (dir.path() / "profile").string() +
      " --print-to-pdf=" + pdf.string() + " 'file://" + page.string() + "' >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  const std::string bytes = bytes_of(pdf);
  const std::regex box(R"(/MediaBox ?\[0 0 ([0-9.]+) ([0-9.]+)\])");
  PrintedPages printed;
  for (std::sregex_iterator it(bytes.begin(), bytes.end(), box); it != std::sregex_iterator(); ++it) {
    const double width_mm = std::stod((*it)[1]) / 72 * 25.4, height_mm = std::stod((*it)[2]) / 72 * 25.4;
    const auto is = [&](double w, double h) {
      return std::abs(width_mm - w) < 0.5 && std::abs(height_mm - h) < 0.5;
    };
    ++printed.all;
    if (is(210, 297)) ++printed.a4_upright;
    if (is(297, 210)) ++printed.a4_wide;
  }
  return printed;
}

std::string cut_on_desktop(const std::filesystem::path& page) {
  const TemporaryDirectory dir;
  dir.write("desktop.html", desktop_frame(bytes_of(page)));
  const std::string options = std::string(kTexts) + "--allow-file-access-from-files";
  return text_of(dumped(dir.path() / "desktop.html", "", options).dom, "cut");
}

}  // namespace karst::test
