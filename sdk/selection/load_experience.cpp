#include "sdk/selection/load_experience.h"

#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/campaign/plan/mesh_hash.h"
#include "sdk/campaign/store/store.h"
#include "sdk/selection/describe.h"

namespace karst::selection {
namespace {

using core::InputError;

void describe_caves(campaign::CampaignResults& results, const std::string& store,
                    const std::function<void(const std::string&)>& tell) {
  for (std::size_t c = 0; c < results.caves.size(); ++c) {
    campaign::CaveEntry& cave = results.caves[c];
    if (!cave.description.empty()) continue;
    try {
      tell("describing " + cave.name);
      if (!cave.hash.empty() && mesh_hash_of(cave.file, cave.start) != cave.hash)
        throw InputError(cave.file, "", "is not the mesh any more that was flown");
      cave.description = to_json(describe_file(cave.file, cave.start).figures);
    } catch (const InputError& e) {
      tell("left out, it cannot be described: " + std::string(e.what()));
      continue;
    }
    try {
      campaign::Store::open(campaign::store_file(store)).describe_cave(c, cave.description);
    } catch (const InputError& e) {  // read-only, or another process writes: described again next time
      tell("not kept: " + std::string(e.what()));
    }
  }
}

Experience one(const std::string& file, const std::function<void(const std::string&)>& tell) {
  if (std::filesystem::path(file).extension() == ".info") return read_experience(file);
  campaign::CampaignResults results = campaign::read_results(file);
  describe_caves(results, file, tell);
  return learn(results, file);
}

}  // namespace

Experience load_experience(const std::vector<std::string>& files,
                           const std::function<void(const std::string&)>& tell) {
  if (files.empty()) throw InputError("results", "", "no file is given");
  Experience all = one(files.front(), tell);
  for (std::size_t i = 1; i < files.size(); ++i) all = merged(all, one(files[i], tell), files[i]);
  for (const std::string& file : files) all.source += (all.source.empty() ? "" : ", ") + file;
  return all;
}

std::string mesh_hash_of(const std::string& cave_file, const std::string& start) {
  if (source_of(cave_file) != Source::mesh) return "";
  return campaign::mesh_hash(cave::mesh_of(cave::describe_cave(cave_file, start)));
}

std::string installed_experience() {
  const std::filesystem::path file = core::install_root() / "share" / "karst" / "experience.info";
  return std::filesystem::is_regular_file(file) ? file.string() : "";
}

}  // namespace karst::selection
