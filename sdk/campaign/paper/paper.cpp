#include "sdk/campaign/paper/paper.h"

#include <system_error>

#include "core_stack/common/error.h"
#include "sdk/campaign/paper/latex.h"
#include "sdk/campaign/paper/markdown.h"
#include "sdk/campaign/paper/methods.h"
#include "sdk/campaign/paper/result_plots.h"
#include "sdk/campaign/paper/result_tables.h"
#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/page/pdf.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using Texts = std::map<std::string, std::string>;

void add_table(Texts& texts, const std::string& name, const PaperTable& table) {
  texts[name + ".tex"] = latex_table(table);
  texts[name + ".md"] = markdown_table(table);
}

std::string paragraph(const std::vector<std::string>& sentences, std::string (*escaped)(std::string_view)) {
  std::string text;
  for (const std::string& s : sentences) text += escaped(s) + "\n";  // a line each: easy to edit and compare
  return text;
}

/// All files to be written, the PDF of each figure included.
std::vector<fs::path> files_of(const Texts& texts, const fs::path& folder, bool with_pdf) {
  std::vector<fs::path> files;
  for (const auto& [name, text] : texts) {
    files.push_back(folder / name);
    if (with_pdf && files.back().extension() == ".svg")
      files.push_back(fs::path(files.back()).replace_extension(".pdf"));
  }
  return files;
}

}  // namespace

Texts paper_texts(const ResultsWithExtras& campaign, const VerdictOptions& options) {
  const CampaignResults& results = campaign.results;
  const Verdicts verdicts = compare_all(results, options);
  if (results.trials.empty()) throw core::InputError(results.name, "", "no flight of it has ended yet");
  Texts texts;
  add_table(texts, "ranking", ranking_table(results, verdicts, options));
  if (results.contestants.size() > 1) {
    add_table(texts, "comparisons", comparisons_table(results, verdicts, options));
    texts["differences.svg"] = differences_plot(results, report_verdicts(verdicts));
  }
  if (const nlohmann::ordered_json curves = report_curves(results, options); !curves.is_null())
    texts["coverage.svg"] = coverage_plot(results, curves);
  texts["caves.svg"] =
      caves_plot(results, report_summary(results, options, verdicts.metric), verdicts.metric);
  const std::vector<std::string> methods = methods_sentences(campaign, verdicts, options);
  texts["methods.tex"] = paragraph(methods, latex_text);
  texts["methods.md"] = paragraph(methods, markdown_text);
  return texts;
}

PaperFiles write_paper(const fs::path& folder_or_store, const fs::path& folder, const PaperOptions& options) {
  const ResultsWithExtras campaign = read_with_extras(folder_or_store);
  VerdictOptions verdict;
  verdict.metric = options.metric.empty() ? campaign.results.metric : options.metric;
  verdict.simulations = 0;  // a paper has no forecast
  const Texts texts = paper_texts(campaign, verdict);
  const auto converter = evaluation::pdf_converter(options.search_path);
  PaperFiles files{files_of(texts, folder, converter.has_value()), converter.has_value()};
  std::error_code error, no_matter;
  for (const fs::path& file : files.written)
    if (options.if_there == IfThere::refuse && fs::exists(file, no_matter))
      throw core::InputError(file.string(), "", "is there already; --force overwrites it");
  fs::create_directories(folder, error);
  if (error) throw core::InputError(folder.string(), "", "cannot be made: " + error.message());
  for (const auto& [name, text] : texts) evaluation::write_whole_file(folder / name, text);
  for (const fs::path& file : files.written)
    if (converter && file.extension() == ".pdf")
      evaluation::write_pdf(*converter, fs::path(file).replace_extension(".svg"), file);
  return files;
}

}  // namespace karst::campaign
