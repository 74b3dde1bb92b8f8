#include "sdk/tools/from_cloud_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/output_file.h"
#include "plugins/simulator/cave/cave_blocks.h"
#include "plugins/simulator/cave/propose_start.h"
#include "sdk/cave_from_cloud/cave_from_cloud.h"
#include "sdk/cave_from_cloud/poisson.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/cave_files.h"
#include "sdk/tools/from_cloud_text.h"
#include "sdk/tools/mesh_options.h"
#include "sdk/tools/step_progress.h"

namespace karst::tools {
namespace {

using core::InputError;
using core::Vec3;
using from_cloud::CaveFromCloud;

struct FromCloudArguments {
  std::string cloud, out, path, start;
  std::vector<std::string> scanners;
  MeshOptions mesh;
  from_cloud::CloudOptions options;
  bool estimate_normals = false, force = false, json = false;
};

/// Places of the path, half a metre apart.
void append_path(const std::string& file, std::vector<Vec3>& places) {
  constexpr double kStep_m = 0.5;
  if (!std::filesystem::exists(file)) throw InputError(file, "", "cannot be opened: no such file");
  std::vector<std::string> problems;
  const std::vector<evaluation::StampedPose> poses = evaluation::read_tum(file, problems);
  if (poses.empty())
    throw InputError(file, "", problems.empty() ? "holds no pose" : "holds no pose: " + problems.front());
  for (const std::string& p : problems) print_error("karst: %s\n", p.c_str());
  const std::size_t first = places.size();
  for (const evaluation::StampedPose& pose : poses)
    if (const Vec3& p = pose.T_world_body.position;
        places.size() == first || (p - places.back()).norm() >= kStep_m)
      places.push_back(p);
}

from_cloud::CloudOptions cloud_options_of(const FromCloudArguments& args) {
  from_cloud::CloudOptions options = args.options;
  options.file_normals = !args.estimate_normals;
  for (const std::string& s : args.scanners)
    options.views.push_back(cave::read_vector("command line", "--scanner", s));
  if (!args.path.empty()) append_path(args.path, options.views);
  if (!args.start.empty()) options.start = cave::read_start("command line, --start", args.start);
  return options;
}

/// What repeats the command.
std::string command_of(const FromCloudArguments& args, double resolution_m) {
  std::string text =
      "karst cave from-cloud \"" + args.cloud + "\"" + core::format_text(" --resolution %g", resolution_m);
  for (const auto& [key, value] : args.mesh) text += " --" + key + " \"" + value + "\"";
  for (const std::string& s : args.scanners) text += " --scanner \"" + s + "\"";
  if (!args.path.empty()) text += " --path \"" + args.path + "\"";
  if (args.estimate_normals) text += " --estimate-normals";
  if (!args.start.empty()) text += " --start \"" + args.start + "\"";
  return text;
}

void write_info_file(const CaveFiles& files, const FromCloudArguments& args, const cave::MeshFrame& frame,
                     const CaveFromCloud& made, const std::vector<std::string>& lines) {
  std::ofstream out = core::open_output(files.info);
  out << comment_line("made by: " + command_of(args, made.report.resolution_m));
  if (!cave::is_plain(frame)) out << comment_line("the cloud was read as: " + cave::to_text(frame));
  for (const std::string& line : lines) out << comment_line("  " + line);
  out << "mesh \"" << files.mesh_name << "\"\n";
  if (made.start) out << "start \"" << cave::start_text(*made.start) << "\"\n";
  out << "reflectivity 0.5\n";
  out.flush();
  if (!out) throw InputError(files.info, "", "cannot be written");
}

void make_from_cloud(const FromCloudArguments& args) {
  if (!from_cloud::has_poisson())
    throw std::runtime_error("this karst was built without PCL: apt-get install libpcl-dev and build again");
  cave::MeshFrame frame = cave::mesh_frame("command line", args.cloud, mesh_keys_of(args.mesh));
  frame.given_as_options = true;
  const from_cloud::CloudOptions options = cloud_options_of(args);
  const CaveFiles files = new_cave_files(args.out, "ply", args.force);
  StepProgress progress;
  const CaveFromCloud made = from_cloud::cave_from_cloud(
      args.cloud, frame, options, [&](const char* step, double fraction) { progress(step, fraction); });
  progress.end();
  cave::write_mesh(files.mesh, made.mesh);
  const std::uintmax_t mesh_bytes = std::filesystem::file_size(files.mesh);
  const std::vector<std::string> lines = report_lines(made, mesh_bytes);
  write_info_file(files, args, frame, made, lines);
  if (args.json) {
    nlohmann::ordered_json j = report_json(made, mesh_bytes);
    j["mesh"] = files.mesh;
    j["info"] = files.info;
    print_json(j);
    return;
  }
  print_out("%s\n", args.cloud.c_str());
  for (const std::string& line : lines) print_out("  %s\n", line.c_str());
  print_out("written: %s, %s\nnext:\n  karst cave info %s\n  karst fly --cave %s\n", files.mesh.c_str(),
            files.info.c_str(), files.info.c_str(), files.info.c_str());
}

}  // namespace

void add_from_cloud_command(CLI::App& cave) {
  auto args = std::make_shared<FromCloudArguments>();
  CLI::App* command = cave.add_subcommand(
      "from-cloud",
      "Make a cave of a laser scan, with a report of what was guessed: writes OUT.ply and OUT.info");
  command->add_option("cloud", args->cloud, "a point cloud: .ply, .pcd or .las (not .laz)")
      ->type_name(kFile)
      ->required();
  command->add_option("--out,-o", args->out, "path of the cave without ending, such as caves/demo")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  command
      ->add_option(
          "--resolution", args->options.resolution_m,
          "edge of the finest cells of the reconstruction, m; default: from the spacing of the points")
      ->check(number_in(0.02, 5.0));
  command
      ->add_option("--scanner", args->scanners,
                   "\"x y z\", a place of the scanner in the cloud's own coordinates; any number of these")
      ->allow_extra_args(false);
  command->add_option("--path", args->path, "the scanner's trajectory (TUM), in the cloud's own coordinates")
      ->type_name(kFile)
      ->check(not_empty());
  command->add_flag("--estimate-normals", args->estimate_normals, "do not use the normals of the file");
  command
      ->add_option("--start", args->start,
                   "\"x y z [heading]\" in the cave that results, m and degrees, z up")
      ->check(not_empty());
  command
      ->add_option(
          "--guessed-beyond", args->options.guessed_beyond_m,
          "surface farther than this from all points counts as guessed, m; default: twice the resolution")
      ->check(number_in(0.01, 100));
  command->add_option("--cap-limit", args->options.cap_limit_m, "diameter up to which holes are closed, m")
      ->check(number_in(0.01, 1000))
      ->capture_default_str();
  add_mesh_options(*command, args->mesh, ReadFile::cloud);
  command->add_flag("--force", args->force, "overwrite files that exist");
  command->add_flag("--json", args->json, "print the report as JSON");
  command->footer(
      "Examples:\n  karst cave from-cloud scan.las --out caves/real\n"
      "  karst cave from-cloud scan.las --offset \"672000 5200000 430\" --out caves/real\n"
      "  karst cave from-cloud slam.pcd --path trajectory.tum --resolution 0.2 --out caves/real");
  command->callback([args] { make_from_cloud(*args); });
}

}  // namespace karst::tools
