// INFO text of others, and a campaign's definition: refused with an InputError, or a tree that can be written
// and read again.
#include <boost/property_tree/info_parser.hpp>
#include <cstdlib>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/info_reader.h"
#include "sdk/campaign/plan/plan.h"
#include "sdk/campaign/plan/plan_text.h"
#include "sdk/campaign/store/results.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace karst;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto tree = core::parse_info(text, "text");
    std::ostringstream again;
    boost::property_tree::write_info(again, tree);
    if (again.str().size() < 16'000 && core::parse_info(again.str(), "again") != tree) std::abort();
    campaign::CampaignResults results;
    campaign::read_conditions(text, "text", results);
    const campaign::Plan plan = campaign::plan_of(text, "text");
    const std::string written = campaign::definition_of(plan);
    if (campaign::definition_of(campaign::plan_of(written, "again")) != written) std::abort();
  } catch (const core::InputError&) {
  }
  return 0;
}
