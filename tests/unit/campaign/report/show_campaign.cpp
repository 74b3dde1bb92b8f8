// The page of a campaign made of finished run directories, to look at: show_campaign PAGE REPEAT RUN...
#include <cstdio>
#include <cstdlib>

#include "sdk/campaign/report/report.h"
#include "tests/unit/campaign/fake_campaign.h"

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "usage: show_campaign PAGE REPEAT RUN...\n"), 1;
  const std::vector<std::filesystem::path> runs(argv + 3, argv + argc);
  karst::campaign::write_campaign_report(argv[1], karst::test::campaign_of_runs(runs, std::atoi(argv[2])));
  return 0;
}
