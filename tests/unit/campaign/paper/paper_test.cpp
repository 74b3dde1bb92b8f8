// The files of a paper, from a campaign's folder.
#include "sdk/campaign/paper/paper.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "core_stack/common/error.h"
#include "sdk/evaluation/page/pdf.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/campaign/stored_campaign.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using evaluation::pdf_converter;
using evaluation::write_pdf;
using test::fake_campaign;
using test::TemporaryDirectory;

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder))
    contents[entry.path().filename().string()] = content_of(entry.path());
  return contents;
}

/// What an action complains of; "" if it does not.
std::string complaint_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A folder for $PATH with an rsvg-convert that runs this script.
std::string converter_in(const TemporaryDirectory& dir, const std::string& script) {
  dir.write("rsvg-convert", "#!/bin/sh\n" + script + "\n");
  fs::permissions(dir.path() / "rsvg-convert", fs::perms::owner_all);
  return dir.path().string();
}

TEST(Paper, WritesTablesFiguresAndMethodsTheSameBytesEachTime) {
  TemporaryDirectory dir;
  test::store_campaign(fake_campaign(3, 2, 4), dir.path());
  const PaperFiles first = write_paper(dir.path(), dir.path() / "a", {});
  write_paper(store_file(dir.path()), dir.path() / "deep" / "b", {});
  const auto contents = contents_of(dir.path() / "a");
  EXPECT_EQ(contents, contents_of(dir.path() / "deep" / "b"));
  EXPECT_EQ(first.written.size(), contents.size());
  EXPECT_FALSE(first.with_pdf);
  for (const char* name : {"ranking.tex", "ranking.md", "comparisons.tex", "comparisons.md", "coverage.svg",
                           "differences.svg", "caves.svg", "methods.tex", "methods.md"}) {
    ASSERT_TRUE(contents.contains(name)) << name;
    EXPECT_FALSE(contents.at(name).empty()) << name;
  }
  EXPECT_EQ(contents.size(), 9u);
  EXPECT_TRUE(contains(contents.at("methods.tex"), "0.1.0+0123456789ab"));
  EXPECT_TRUE(contains(contents.at("methods.tex"), "policy\\_1"));
  EXPECT_TRUE(contains(contents.at("methods.tex"), "coverage\\_auc"));
}

TEST(Paper, IsOfTheFigureAskedForOrDeclared) {
  TemporaryDirectory dir;
  test::store_campaign(fake_campaign(2, 1, 3), dir.path(), "metric coverage\n");
  PaperOptions options;
  write_paper(dir.path(), dir.path() / "declared", options);
  options.metric = "path_length_m";
  write_paper(dir.path(), dir.path() / "asked", options);
  EXPECT_TRUE(contains(content_of(dir.path() / "declared/ranking.md"), "by final coverage (coverage)"));
  EXPECT_TRUE(contains(content_of(dir.path() / "asked/ranking.md"), "by path length (path\\_length\\_m)"));
  options.metric = "beauty";
  EXPECT_TRUE(
      contains(complaint_of([&] { write_paper(dir.path(), dir.path() / "none", options); }), "beauty"));
  EXPECT_FALSE(fs::exists(dir.path() / "none"));
}

TEST(Paper, OfOneContestantHasNoComparisons) {
  TemporaryDirectory dir;
  test::store_campaign(fake_campaign(1, 1, 2), dir.path());
  write_paper(dir.path(), dir.path() / "paper", {});
  const auto contents = contents_of(dir.path() / "paper");
  EXPECT_FALSE(contents.contains("comparisons.tex"));
  EXPECT_FALSE(contents.contains("differences.svg"));
  EXPECT_TRUE(contents.contains("ranking.tex"));
}

TEST(Paper, OfNoFlightsIsAnError) {
  TemporaryDirectory dir;
  test::store_campaign(fake_campaign(2, 1, 0), dir.path());
  EXPECT_TRUE(contains(complaint_of([&] { write_paper(dir.path(), dir.path() / "paper", {}); }),
                       "no flight of it has ended yet"));
  EXPECT_FALSE(fs::exists(dir.path() / "paper"));
}

TEST(Paper, OverwritesNothingUnlessAsked) {
  TemporaryDirectory dir;
  test::store_campaign(fake_campaign(2, 1, 3), dir.path());
  const fs::path paper = dir.path() / "paper";
  fs::create_directories(paper);
  std::ofstream(paper / "methods.md") << "mine";
  const std::string complaint = complaint_of([&] { write_paper(dir.path(), paper, {}); });
  EXPECT_TRUE(contains(complaint, (paper / "methods.md").string() + ": is there already; --force"))
      << complaint;
  EXPECT_EQ(contents_of(paper).size(), 1u) << "nothing is written";
  EXPECT_EQ(content_of(paper / "methods.md"), "mine");
  PaperOptions options;
  options.if_there = IfThere::overwrite;
  write_paper(dir.path(), paper, options);
  EXPECT_NE(content_of(paper / "methods.md"), "mine");
}

TEST(Paper, HasAPdfOfEachFigureWhereThereIsAConverter) {
  TemporaryDirectory dir, bin;
  test::store_campaign(fake_campaign(2, 1, 3), dir.path());
  PaperOptions options;
  options.search_path =
      "/nowhere:" + converter_in(bin, "echo \"$SOURCE_DATE_EPOCH $1 $2 $3\" > \"$4\"; cat \"$5\" >> \"$4\"");
  const PaperFiles files = write_paper(dir.path(), dir.path() / "paper", options);
  EXPECT_TRUE(files.with_pdf);
  const auto contents = contents_of(dir.path() / "paper");
  EXPECT_EQ(contents.size(), 12u);
  EXPECT_EQ(files.written.size(), 12u);
  for (const char* figure : {"caves", "coverage", "differences"})
    EXPECT_EQ(contents.at(figure + std::string(".pdf")),
              "0 --format pdf --output\n" + contents.at(figure + std::string(".svg")));
}

TEST(Paper, AConverterThatFailsIsNamedWithWhatItSays) {
  TemporaryDirectory dir, bin;
  test::store_campaign(fake_campaign(2, 1, 3), dir.path());
  PaperOptions options;
  options.search_path = converter_in(bin, "echo half > \"$4\"; echo no fonts >&2; exit 3");
  const std::string complaint = complaint_of([&] { write_paper(dir.path(), dir.path() / "paper", options); });
  EXPECT_TRUE(contains(complaint, "caves.pdf: cannot be made")) << complaint;
  EXPECT_TRUE(contains(complaint, "exit code 3: no fonts")) << complaint;
  for (const auto& [name, content] : contents_of(dir.path() / "paper"))
    EXPECT_FALSE(contains(name, ".pdf")) << name << " is half of one";
}

TEST(PdfConverter, IsLookedForInThePathAndMustBeAProgram) {
  TemporaryDirectory bin;
  EXPECT_FALSE(pdf_converter(""));
  EXPECT_FALSE(pdf_converter(bin.path().string()));
  bin.write("rsvg-convert", "no program");
  EXPECT_FALSE(pdf_converter(bin.path().string()));
  converter_in(bin, "true");
  EXPECT_EQ(pdf_converter(bin.path().string()).value_or(""), bin.path() / "rsvg-convert");
}

TEST(PdfConverter, OfDebianGivesTheSameBytes) {
  const char* path = std::getenv("PATH");
  const auto converter = pdf_converter(path ? path : "");
  if (!converter) GTEST_SKIP() << "skipped: no rsvg-convert";
  TemporaryDirectory dir;
  dir.write("a.svg", paper_texts({fake_campaign(2, 1, 3), {}}, {}).at("coverage.svg"));
  write_pdf(*converter, dir.path() / "a.svg", dir.path() / "a.pdf");
  write_pdf(*converter, dir.path() / "a.svg", dir.path() / "b.pdf");
  EXPECT_EQ(content_of(dir.path() / "a.pdf").substr(0, 5), "%PDF-");
  EXPECT_EQ(content_of(dir.path() / "a.pdf"), content_of(dir.path() / "b.pdf"));
}

}  // namespace
}  // namespace karst::campaign
