// What runs in a policy's own process: karst-policy-child, started by PolicyProcess and by nobody else.
#pragma once
namespace karst::host {

constexpr int kRequestsDescriptor = 3;  // the host's memory, read-only
constexpr int kAnswersDescriptor = 4;   // this process's

/// Confines the process, opens the plugin and serves the host until it says end. Returns the exit code.
int serve_policy();

}  // namespace karst::host
