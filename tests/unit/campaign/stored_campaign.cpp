#include "tests/unit/campaign/stored_campaign.h"

#include <set>

#include "sdk/campaign/store/store.h"

namespace karst::test {

void store_campaign(const campaign::CampaignResults& results, const std::filesystem::path& folder,
                    const std::string& definition) {
  std::set<std::int64_t> seeds;
  for (const campaign::TrialResult& t : results.trials) seeds.insert(t.seed);
  campaign::StoreHead head;
  head.name = results.name;
  head.definition = definition;
  head.horizon_s = results.horizon_s;
  head.contestants = results.contestants;
  head.caves = results.caves;
  head.seeds.assign(seeds.begin(), seeds.end());
  campaign::Store store = campaign::Store::create(campaign::store_file(folder), head);
  for (const campaign::TrialResult& t : results.trials) {
    campaign::StoredTrial trial;
    trial.result = t;
    trial.binary_version = "0.1.0+0123456789ab";
    store.add(trial);
  }
}

}  // namespace karst::test
