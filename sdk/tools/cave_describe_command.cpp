#include "sdk/tools/cave_describe_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/json_text.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/selection/describe.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/mesh_options.h"

namespace karst::tools {
namespace {

struct DescribeArguments {
  std::string file, start;
  MeshOptions mesh;
  bool json = false;
};

selection::CaveFigures figures_of(const DescribeArguments& args) {
  if (args.mesh.empty()) return selection::describe_file(args.file, args.start).figures;
  if (selection::source_of(args.file) != selection::Source::mesh)
    throw core::InputError(args.file, args.mesh.front().first, "is of use with a mesh only");
  const cave::Cave cave = cave::load_cave(args.file, args.start, mesh_keys_of(args.mesh));
  return selection::describe(
      selection::free_space_of(cave.scene, cave.description.start.position, {}, args.file));
}

void describe(const DescribeArguments& args) {
  const selection::CaveFigures figures = figures_of(args);
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
  like->add_option("file", d->file, "a cave's .info file, a mesh, or the map of a flight (.bt, .ot)")
      ->type_name(kFile)
      ->required();
  like->add_option("--start", d->start, "\"x y z\", m, for a mesh or instead of the file's own")
      ->check(not_empty());
  add_mesh_options(*like, d->mesh);
  like->add_flag("--json", d->json, "print JSON");
  like->callback([d] { describe(*d); });
}

}  // namespace karst::tools
