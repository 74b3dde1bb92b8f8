#include "sdk/survey/read_survey.h"

#include "core_stack/common/error.h"
#include "sdk/survey/adjust.h"
#include "sdk/survey/lower_case.h"
#include "sdk/survey/survex_reader.h"
#include "sdk/survey/therion_reader.h"

namespace karst::survey {

Survey read_survey(const std::string& file) {
  const std::string ending = ending_of(file);
  if (ending == ".th") return adjusted(read_therion(file));
  if (ending == ".svx" || ending == ".dat" || ending == ".mak") return read_by_cavern(file);
  if (ending == ".3d" || ending == ".plt") return read_processed(file);
  throw core::InputError(file, "", "is no survey by its name: .th, .svx, .3d, .dat, .mak and .plt are read");
}

}  // namespace karst::survey
