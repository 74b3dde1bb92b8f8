#include "sdk/tools/cave_describe_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core_stack/common/install_location.h"
#include "core_stack/common/json_text.h"
#include "sdk/selection/describe.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

struct DescribeArguments {
  std::string file, start;
  bool json = false;
};

void describe(const DescribeArguments& args) {
  const selection::CaveFigures figures = selection::describe_file(args.file, args.start).figures;
  if (args.json)
    print_json(core::json_of<nlohmann::ordered_json>(selection::to_json(figures)));
  else
    print_out("%s\n%s", args.file.c_str(), selection::to_text(figures).c_str());
}

}  // namespace

void add_cave_describe(CLI::App& cave) {
  auto d = std::make_shared<DescribeArguments>();
  CLI::App* like = cave.add_subcommand(
      "describe",
      "What a cave is like: the figures by which karst select compares caves\n\nThey are explained in " +
          core::doc_path("docs/select.md") + ".");
  like->add_option("file", d->file, "A cave's .info file, a mesh, or the map of a flight (.bt, .ot)")
      ->type_name(kFile)
      ->required();
  like->add_option("--start", d->start, "\"x y z\", for a mesh or instead of the file's own")
      ->check(not_empty());
  like->add_flag("--json", d->json, "Write JSON");
  like->callback([d] { describe(*d); });
}

}  // namespace karst::tools
