// What the documentation quotes is there: code of examples, fields of the ABI, reasons for refusing a goal,
// pages linked, sources named, versions of files. Its lines are no longer than a screen is wide.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path root = KARST_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

/// Runs of blanks become one.
std::string squeezed(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }

std::vector<std::smatch> all_matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), {}};
}

std::vector<fs::path> pages() {
  std::vector<fs::path> out{root / "README.md", root / "CONTRIBUTING.md"};
  for (const auto& e : fs::recursive_directory_iterator(root / "docs"))
    if (e.path().extension() == ".md") out.push_back(e.path());
  return out;
}

TEST(Documents, QuoteExamplesWordForWord) {
  std::size_t quotes = 0;
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    const std::regex quote("<!-- (examples/[^ ]+) -->\n```[a-z]+\n([^`]*)```");
    for (const std::smatch& m : all_matches(text, quote)) {
      EXPECT_NE(text_of(root / m[1].str()).find(m[2].str()), std::string::npos)
          << page << " quotes what is not in " << m[1] << ":\n"
          << m[2];
      ++quotes;
    }
  }
  EXPECT_GE(quotes, 12u);
}

TEST(Documents, LinkPagesThatThereAre) {
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    for (const std::smatch& m : all_matches(text, std::regex("\\]\\(([^)#: ]+)(#[^)]*)?\\)")))
      EXPECT_TRUE(fs::exists(page.parent_path() / m[1].str())) << page << " links " << m[1];
  }
}

/// Whether a source is named so: by its path, or by the end of its path.
bool is_source(const std::string& name) {
  static const std::vector<std::string> sources = [] {
    std::vector<std::string> all;
    for (const char* folder : {"core_stack", "sdk", "plugins", "policies", "tests", "examples", "cmake"})
      for (const auto& e : fs::recursive_directory_iterator(root / folder))
        all.push_back("/" + fs::relative(e.path(), root).string());
    return all;
  }();
  return std::any_of(sources.begin(), sources.end(),
                     [&](const std::string& path) { return path.ends_with("/" + name); });
}

TEST(Documents, NameSourcesThatThereAre) {
  const std::regex file("`([\\w./-]+\\.(h|hpp|cpp|c|py|sh|cmake))`"),
      place("`((core_stack|sdk|plugins|policies)/[\\w./-]*\\w)/?`");
  std::size_t names = 0;
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    for (const std::smatch& m : all_matches(text, file)) {
      EXPECT_TRUE(is_source(m[1])) << page << " names " << m[1];
      ++names;
    }
    for (const std::smatch& m : all_matches(text, place)) {
      const std::string name = m[1];  // with or without the ending
      EXPECT_TRUE(is_source(name) || is_source(name + ".h") || is_source(name + ".cpp"))
          << page << " names " << name;
    }
  }
  EXPECT_GT(names, 200u);
}

/// The fields of every struct in the ABI's headers, by the struct's name (with _t).
std::map<std::string, std::set<std::string>> declared_fields() {
  std::map<std::string, std::set<std::string>> out;
  for (const auto& e : fs::directory_iterator(root / "sdk/abi")) {
    if (e.path().extension() != ".h") continue;
    const std::string header = std::regex_replace(text_of(e.path()), std::regex("/\\*[^]*?\\*/"), "");
    for (const std::smatch& s : all_matches(header, std::regex("struct (karst_\\w+) \\{([^}]*)\\}"))) {
      const std::string body = squeezed(s[2]);
      std::set<std::string>& fields = out[s[1].str() + "_t"];
      std::istringstream declarations(body);
      for (std::string d; std::getline(declarations, d, ';');) {
        if (d.find_first_not_of(' ') == std::string::npos) continue;
        if (std::smatch slot; std::regex_search(d, slot, std::regex("\\(\\*(\\w+)\\)"))) {
          fields.insert(slot[1]);
          continue;
        }
        for (const std::smatch& name : all_matches(d, std::regex("(\\w+) *(\\[\\w+\\] *)?(,|$)")))
          fields.insert(name[1]);
      }
    }
  }
  return out;
}

TEST(Reference, HasEveryFieldOfTheHeadersAndNoOther) {
  const std::string page = text_of(root / "docs/policy_reference.md");
  const auto declared = declared_fields();
  ASSERT_GE(declared.size(), 29u);
  EXPECT_EQ(declared.at("karst_vec3_t"), (std::set<std::string>{"x", "y", "z"}))
      << "the headers are read wrongly";
  EXPECT_TRUE(declared.at("karst_policy_t").contains("on_event"));
  EXPECT_TRUE(declared.at("karst_error_t").contains("text"));
  for (const auto& [type, fields] : declared) {
    const std::size_t begin = page.find("### `" + type + "`");
    ASSERT_NE(begin, std::string::npos) << "docs/policy_reference.md has no section for " << type;
    const std::string section = page.substr(begin, page.find("\n#", begin + 1) - begin);
    std::set<std::string> listed{"size", "reserved"};  // said of all structs at the head of the page
    for (const std::smatch& m : all_matches(section, std::regex("\n\\| `(\\w+)` \\|"))) listed.insert(m[1]);
    for (const std::string& field : fields) EXPECT_TRUE(listed.contains(field)) << type << " has " << field;
    for (const std::string& field : listed)
      EXPECT_TRUE(fields.contains(field) || field == "size" || field == "reserved")
          << type << " has no " << field;
  }
}

TEST(Reference, NamesEveryConstantOfTheHeaders) {
  std::string pages_of_abi;
  for (const char* page : {"policy_reference.md", "goals.md", "abi.md"})
    pages_of_abi += text_of(root / "docs" / page);
  // What is named by its last word, within a list of its kind.
  const std::set<std::string> guards_and_sizes{"KARST_ERROR_TEXT_SIZE", "KARST_PLUGIN_ENTRY_NAME",
                                               "KARST_NOEXCEPT", "KARST_EXPORT", "KARST_API"};
  std::size_t constants = 0;
  for (const auto& e : fs::directory_iterator(root / "sdk/abi")) {
    if (e.path().extension() != ".h") continue;
    const std::string header = std::regex_replace(text_of(e.path()), std::regex("/\\*[^]*?\\*/"), "");
    for (const std::smatch& m :
         all_matches(header, std::regex("(#define )?\\b(KARST_[A-Z_0-9]+)( = | [\"0-9])"))) {
      const std::string name = m[2];
      if (guards_and_sizes.contains(name) || name.ends_with("_H")) continue;
      const bool event = name.starts_with("KARST_EVENT_");
      EXPECT_NE(pages_of_abi.find(event ? "`" + name.substr(12) + "`" : name), std::string::npos) << name;
      ++constants;
    }
  }
  EXPECT_GT(constants, 40u);
}

TEST(Goals, QuoteTheReasonsThatTheSourcesGive) {
  std::string sources;
  for (const char* folder : {"core_stack/mission", "sdk/host"})
    for (const auto& e : fs::recursive_directory_iterator(root / folder))
      if (e.path().extension() == ".cpp") sources += text_of(e.path());
  const std::string page = text_of(root / "docs/goals.md");
  std::size_t reasons = 0;
  for (const std::smatch& m : all_matches(page, std::regex("`((its|it|the|no|passed|going) [^`.]*[^`. ])"))) {
    EXPECT_NE(sources.find(m[1]), std::string::npos) << "docs/goals.md quotes: " << m[1];
    ++reasons;
  }
  EXPECT_GE(reasons, 16u);
}

/// The one number that the pattern's group has in this source.
std::string number_in(const char* source, const char* pattern) {
  const std::string text = text_of(root / source);
  const auto found = all_matches(text, std::regex(pattern));
  EXPECT_EQ(found.size(), 1u) << source << " has no single " << pattern;
  return found.empty() ? "" : found.front()[1].str();
}

/// The latest version of every schema and extension that text between these marks names: "karst.metrics/1".
std::map<std::string, int> latest_schemas(const std::string& text, const std::string& mark) {
  std::map<std::string, int> latest;
  for (const std::smatch& m : all_matches(text, std::regex(mark + "(karst\\.[a-z_]+)/([0-9]+)" + mark)))
    latest[m[1]] = std::max(latest[m[1]], std::stoi(m[2]));
  return latest;
}

/// The second cell of the table's row that begins so.
std::string version_said(const std::string& page, const std::string& interface) {
  const std::size_t row = page.find("\n| " + interface);
  EXPECT_NE(row, std::string::npos) << "docs/formats.md has no row " << interface;
  if (row == std::string::npos) return "";
  const std::size_t begin = page.find(" | ", row + 3) + 3;
  return page.substr(begin, page.find(" | ", begin) - begin);
}

TEST(Formats, HaveTheVersionsOfTheSources) {
  const std::string page = text_of(root / "docs/formats.md");
  const auto says = [&](const std::string& interface) { return version_said(page, interface); };
  EXPECT_EQ(says("policy ABI"), number_in("sdk/abi/karst_abi.h", "#define KARST_ABI_MAJOR (\\d+)") + "." +
                                    number_in("sdk/abi/karst_abi.h", "#define KARST_ABI_MINOR (\\d+)"));
  EXPECT_EQ(
      says("`requests.bin`"),
      "records " + number_in("sdk/host/serialization/request_log.cpp", "constexpr int kSchema = (\\d+);") +
          ", requests " +
          number_in("sdk/host/serialization/flat_request.cpp", "constexpr std::uint32_t kVersion = (\\d+);"));
  EXPECT_EQ(says("`campaign.sqlite`"),
            "`karst.campaign/1`, `user_version` " +
                number_in("sdk/campaign/store/store_schema.h", "constexpr int kSchemaVersion = (\\d+);"));
  for (const char* source : {"sdk/tools/check_command.cpp", "sdk/tools/request_replay_command.cpp"})
    EXPECT_EQ(says("`karst policy check --json`"), number_in(source, "\\{\"schema\", (\\d+)\\}")) << source;
  EXPECT_EQ(says("radio frames of a team"),
            number_in("core_stack/team/communication/messages.h", "kWireVersion = (\\d+);"));

  std::string sources;
  for (const char* folder : {"core_stack", "sdk"})
    for (const auto& e : fs::recursive_directory_iterator(root / folder)) {
      const std::string path = fs::relative(e.path(), root).string();
      const bool is_code = path.ends_with(".h") || path.ends_with(".cpp");
      if (is_code && !path.starts_with("sdk/check/"))
        sources += text_of(e.path());  // it asks for unknown ones
    }
  std::map<std::string, int> in_sources = latest_schemas(sources, "\"");
  in_sources.erase("karst.example");  // of the ABI's comments
  EXPECT_EQ(latest_schemas(page, "`"), in_sources);
}

TEST(Formats, NameTheVersionOfKarst) {
  const std::string version = number_in("CMakeLists.txt", "project\\(karst VERSION ([\\d.]+)");
  EXPECT_EQ(number_in("docs/formats.md", "karst itself has version ([\\d.]*\\d)"), version);
  EXPECT_EQ(number_in("CITATION.cff", "\nversion: ([\\d.]+)"), version);
}

std::size_t characters(const std::string& utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

// Not code, formulas (which are indented by four) and rows of tables, which cannot be broken.
TEST(Documents, HaveLinesOfAtMost120Characters) {
  std::vector<fs::path> all = pages();
  all.insert(all.end(), {root / "CHANGELOG.md", root / "SECURITY.md"});
  std::size_t lines = 0;
  for (const fs::path& page : all) {
    std::istringstream text(text_of(page));
    bool in_code = false;
    std::size_t number = 0;
    for (std::string line; std::getline(text, line);) {
      ++number;
      const std::size_t begin = line.find_first_not_of(' ');
      if (begin == std::string::npos) continue;
      const bool fence = line.compare(begin, 3, "```") == 0;
      in_code = in_code != fence;
      if (in_code || fence || line[begin] == '|' || begin >= 4) continue;
      EXPECT_LE(characters(line), 120u) << page << ":" << number;
      ++lines;
    }
  }
  EXPECT_GT(lines, 3000u);
}

}  // namespace
