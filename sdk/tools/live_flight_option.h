// `karst fly --live`: a flight that is followed (docs/live.md).
#pragma once
#include "sdk/tools/fly_command.h"

namespace karst::tools {

/// See LiveStarter. Throws core::InputError if the address cannot be served.
std::shared_ptr<core::RecordListener> serve_live(const flight::Mission& mission,
                                                 const flight::FlightRequest& request,
                                                 const LiveArguments& args);

}  // namespace karst::tools
