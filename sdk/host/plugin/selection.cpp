#include "sdk/host/plugin/selection.h"

#include <algorithm>
#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/host/plugin/script_file.h"

namespace karst::host {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : ", ") + w;
  return out;
}

std::string missing_text(const std::string& name, const std::vector<PolicyListing>& all,
                         const SearchPath& path) {
  std::vector<std::string> names, broken;
  for (const PolicyListing& p : all) {
    if (p.broken.empty() && p.shadowed_by.empty()) names.push_back(p.id);
    if (!p.broken.empty() && std::filesystem::path(p.file).stem() == name) broken.push_back(p.broken);
  }
  std::string text =
      broken.empty() ? "no plugin offers it" : "the plugin of that name is broken: " + joined(broken);
  const std::string near = core::nearest_name(name, names);
  if (!near.empty()) text += "; did you mean " + near + "?";
  text += names.empty() ? "; no policy was found" : "; there are: " + joined(names);
  std::vector<std::string> places = path.files;
  places.insert(places.end(), path.folders.begin(), path.folders.end());
  return text + "; searched: " + (places.empty() ? "nowhere" : joined(places));
}

}  // namespace

PolicyListing find_policy(const std::string& name, const SearchPath& path) {
  const std::vector<PolicyListing> all = list_policies(path);
  for (const PolicyListing& p : all) {
    const bool explicit_file = std::find(path.files.begin(), path.files.end(), p.file) != path.files.end();
    if (!p.broken.empty() && explicit_file) throw core::InputError(p.file, "", p.broken);
  }
  const auto offers = [&](const PolicyListing& p) { return p.broken.empty() && p.id == name; };
  const auto found = std::find_if(all.begin(), all.end(), offers);
  if (found == all.end()) throw core::InputError("policy", name, missing_text(name, all, path));
  return *found;
}

std::optional<PolicyListing> policy_in_file(const std::string& text) {
  const std::filesystem::path file(text);
  if (!is_script(file) && file.extension() != ".so") return std::nullopt;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw core::InputError(text, "", "there is no such file");
  const std::vector<PolicyListing> all = list_policies({{text}, {}});
  if (all.empty()) throw core::InputError(text, "", "holds no policy");
  if (!all.front().broken.empty()) throw core::InputError(text, "", all.front().broken);
  if (all.size() == 1) return all.front();
  std::vector<std::string> names;
  for (const PolicyListing& p : all) names.push_back(p.id);
  throw core::InputError(
      text, "", "holds several policies: name one of " + joined(names) + ", and give --plugin " + text);
}

void take_policy_file(std::string& policy, std::vector<std::string>& plugins) {
  const std::optional<PolicyListing> found = policy_in_file(policy);
  if (!found) return;
  plugins.insert(plugins.begin(), policy);
  policy = found->id;
}

Selection open_policy(const std::string& file, const std::string& name) {
  Selection out{open_plugin(file), nullptr};
  for (const karst_policy_t* policy : out.plugin.policies)
    if (name == std::string(policy->descriptor->id.data, policy->descriptor->id.length)) out.policy = policy;
  if (out.policy == nullptr)
    throw core::InputError(file, name, "the file offered this policy when listed, but not when opened");
  return out;
}

Selection select_policy(const std::string& name, const SearchPath& path) {
  return open_policy(find_policy(name, path).file, name);
}

}  // namespace karst::host
