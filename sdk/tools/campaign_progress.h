// Progress of a campaign on standard error: on a terminal two lines that are rewritten, otherwise one line
// for each finished trial.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/run/run_campaign.h"
#include "sdk/campaign/store/results.h"

namespace karst::tools {

class CampaignProgress {
 public:
  CampaignProgress(bool quiet, std::size_t jobs);
  ~CampaignProgress();
  CampaignProgress(const CampaignProgress&) = delete;
  CampaignProgress& operator=(const CampaignProgress&) = delete;
  void show(const campaign::Plan& plan, const campaign::Progress& progress);
  /// A line that stays, above the progress.
  void say(const std::string& text);

 private:
  struct Tally {
    double coverage = 0;
    int trials = 0;
  };
  bool quiet_, terminal_;
  std::size_t jobs_;
  bool begun_ = false, drawn_ = false;
  std::vector<Tally> tallies_;
};

}  // namespace karst::tools
