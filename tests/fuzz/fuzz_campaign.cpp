#include "sdk/campaign/plan/campaign.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".info",
                                   [](const std::string& path) { karst::campaign::read_campaign(path); });
}
