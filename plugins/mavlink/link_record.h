// What went over the link, as `mavlink.json` in the run directory.
#pragma once
#include <string>

#include "plugins/mavlink/clock_sync.h"
#include "plugins/mavlink/connection.h"

namespace karst::mavlink {

/// Throws InputError if the file cannot be written.
void write_link_record(const std::string& file, const Connection& connection, const ClockSync& clock,
                       core::TimeNs duration);

}  // namespace karst::mavlink
