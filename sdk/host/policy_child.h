// What runs in a policy's own process: karst-policy-child, started by PolicyProcess and by nobody else.
#pragma once
#include <sys/types.h>

namespace karst::host {

constexpr int kRequestsDescriptor = 3;  // the host's memory, read-only
constexpr int kAnswersDescriptor = 4;   // this process's

/// Confines the process, opens the plugin and serves the host until it says end, or is gone. Returns the exit
/// code.
int serve_policy(pid_t host);

}  // namespace karst::host
