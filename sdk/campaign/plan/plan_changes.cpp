// Changes that would turn a resumed campaign into a different one.
#include <algorithm>
#include <map>

#include "core_stack/common/options.h"
#include "sdk/campaign/plan/plan.h"
#include "sdk/campaign/plan/plan_text.h"

namespace karst::campaign {
namespace {

using Facts = std::map<std::string, std::string>;

Facts facts_of(const PlannedContestant& c, AcceptedBinaries binaries) {
  Facts facts{{"policy", c.policy}, {"plugin", c.plugin}};
  if (binaries == AcceptedBinaries::same) facts["binary"] = c.binary_version, facts["version"] = c.version;
  for (const auto& [key, value] : core::leaves_of(c.mission)) facts[key] = value;
  return facts;
}
Facts facts_of(const PlannedCave& c, AcceptedBinaries) {
  return {{"start", c.start}, {"content", c.hash.substr(0, 12)}};
}

void compare_facts(const std::string& what, const Facts& then, const Facts& now,
                   std::vector<std::string>& out) {
  const auto value = [](const Facts& facts, const std::string& key) {
    const auto found = facts.find(key);
    return found == facts.end() ? std::string("not there") : "\"" + found->second + "\"";
  };
  Facts both = then;
  both.insert(now.begin(), now.end());
  for (const auto& [key, ignored] : both) {
    const std::string was = value(then, key), is = value(now, key);
    if (was == is) continue;
    std::string& text = out.emplace_back(what);
    text.append(": ").append(key).append(" was ").append(was).append(", is ").append(is);
  }
}

template <class Named>
void compare_lists(const std::string& what, const std::vector<Named>& then, const std::vector<Named>& now,
                   AcceptedBinaries binaries, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < then.size(); ++i) {
    if (i >= now.size() || now[i].name != then[i].name)
      out.push_back(what + " " + std::to_string(i + 1) + " was " + then[i].name + ", is " +
                    (i < now.size() ? now[i].name : "missing"));
    else
      compare_facts(what + " " + then[i].name, facts_of(then[i], binaries), facts_of(now[i], binaries), out);
  }
}

}  // namespace

std::vector<std::string> changes(const Plan& then, const Plan& now, AcceptedBinaries binaries) {
  std::vector<std::string> out;
  compare_lists("contestant", then.contestants, now.contestants, binaries, out);
  compare_lists("cave", then.caves, now.caves, binaries, out);
  if (now.seeds.size() < then.seeds.size() ||
      !std::equal(then.seeds.begin(), then.seeds.end(), now.seeds.begin()))
    out.push_back("seeds were " + seeds_text(then.seeds) + ", are " + seeds_text(now.seeds));
  return out;
}

}  // namespace karst::campaign
