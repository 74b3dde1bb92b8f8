#include "sdk/tools/help_commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/help/command_tree.h"
#include "sdk/tools/help/completion.h"
#include "sdk/tools/help/man_pages.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

/// `doc_folder`: where the reader of the pages has the documentation; empty: where this karst has it.
void write_pages(const CLI::App& app, const fs::path& folder, const std::string& doc_folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw core::InputError(folder.string(), "", "cannot be made: " + error.message());
  const std::string here = core::doc_root().string();
  const DocFolders doc{here, doc_folder.empty() ? here : doc_folder};
  for (const auto& [name, text] : man_pages(commands_of(app), KARST_VERSION, doc))
    evaluation::write_whole_file(folder / name, text);
}

}  // namespace

void add_help_commands(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = app.add_subcommand(
      "completion",
      "Print what completes this command's line in a shell\n\n"
      "  source <(karst completion bash)                              in ~/.bashrc\n"
      "  karst completion zsh > ~/.zfunc/_karst                       in a folder of zsh's fpath\n\n"
      "An installed karst puts both where the shells look for them.");
  completion->add_option("shell", *shell, "the shell that reads it")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  completion->callback([shell, &app] {
    const std::vector<Command> commands = commands_of(app);
    std::fputs((*shell == "zsh" ? zsh_completion(commands) : bash_completion(commands)).c_str(), stdout);
  });

  auto folder = std::make_shared<std::string>(), doc_folder = std::make_shared<std::string>();
  CLI::App* man = app.add_subcommand("man", "Write the manual pages: what the installation does")->group("");
  man->add_option("folder", *folder, "folder for the pages")->required()->check(not_empty());
  man->add_option("--doc", *doc_folder, "where the pages' reader has the documentation")->check(not_empty());
  man->callback([folder, doc_folder, &app] { write_pages(app, *folder, *doc_folder); });
}

}  // namespace karst::tools
