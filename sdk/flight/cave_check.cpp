#include "sdk/flight/cave_check.h"

#include <cstdint>
#include <fstream>
#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/input_file.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave/remedies.h"
#include "sdk/evaluation/reachable/cache_file.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::flight {
namespace {

using core::InputError;
namespace fs = std::filesystem;

[[noreturn]] void refuse_without_start(const std::string& cave_file, const core::MeshKeys& keys) {
  const cave::MeshFile mesh = cave::mesh_of(cave_file, keys);
  const cave::RayScene scene(cave::load_mesh(mesh));
  // What is wrong with the mesh comes first: a start would be one in a wrong frame.
  std::string wrong;
  for (const cave::MeshAdvice& a : cave::mesh_advice(cave::shape_of(scene), mesh.frame))
    wrong += cave::to_text(a) + "; ";
  if (!wrong.empty())
    throw InputError(cave_file, "mesh", wrong + "then give a start, \"x y z [heading_deg]\"");
  throw InputError(cave_file, "start",
                   "missing: give \"x y z [heading_deg]\"" + cave::remedies(scene, mesh.frame, std::nullopt));
}

/// What was looked at and found good: a file that has it in its name, and the notes in its lines.
class GoodCave {
 public:
  /// Of what check_cave() looks at: the cave's file, its mesh and its frame, and the start.
  GoodCave(const fs::path& cache, const cave::CaveDescription& cave, const std::string& start) {
    std::uint64_t sum = evaluation::word_sum(start, kVersion);
    sum = evaluation::word_sum(cave::to_text(cave.mesh_frame), sum);
    sum = evaluation::word_sum(cave::lower_extension(cave.mesh_path), sum);
    sum = evaluation::word_sum(core::read_input(cave.mesh_path, core::kMaxMeshFileBytes), sum);
    if (cave.file != cave.mesh_path)
      sum = evaluation::word_sum(core::read_input(cave.file, core::kMaxTextFileBytes), sum);
    file_ = cache / core::format_text("%016llx.good", static_cast<unsigned long long>(sum));
  }
  std::optional<std::vector<std::string>> notes() const {
    std::ifstream in(file_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line); lines.push_back(line))
      if (line == kEnd) return lines;
    return std::nullopt;
  }
  void note(const std::vector<std::string>& notes) const {
    std::string text;
    for (const std::string& line : notes) text += line + "\n";
    evaluation::write_cache_file(file_, text + kEnd + "\n");
  }

 private:
  static constexpr std::uint64_t kVersion = 1;         // of the file and of what check_cave() looks at
  static constexpr const char* kEnd = "can be flown";  // the last line: the file is whole
  fs::path file_;
};

std::vector<std::string> look_at(cave::CaveDescription description) {
  cave::RayScene scene(cave::load_mesh(cave::mesh_of(description)));
  cave::Cave cave{std::move(description), std::move(scene)};
  const core::Vec3 place = cave.description.start.position;
  try {
    cave::lay_objects(cave);
    cave::check_start(cave, 0);  // has the best message for a bad start
    evaluation::check_reachable(cave.scene.mesh(), place, {}, cave.description.mesh_path);
  } catch (const InputError& e) {
    throw InputError(e, cave::remedies(cave.scene, cave.description.mesh_frame, place));
  }
  std::vector<std::string> notes;
  for (const cave::MeshAdvice& a : cave::mesh_advice(cave::shape_of(cave.scene), cave.description.mesh_frame))
    notes.push_back(cave::to_text(a));
  return notes;
}

}  // namespace

std::vector<std::string> check_cave(const std::string& cave_file, const std::string& start,
                                    const core::MeshKeys& keys, const fs::path& cache) {
  if (start.empty() && !cave::has_start(cave_file)) refuse_without_start(cave_file, keys);
  cave::CaveDescription description = cave::describe_cave(cave_file, start, keys);
  if (cache.empty()) return look_at(std::move(description));
  const GoodCave good(cache, description, start);
  if (auto known = good.notes()) return std::move(*known);
  std::vector<std::string> notes = look_at(std::move(description));
  good.note(notes);
  return notes;
}

}  // namespace karst::flight
