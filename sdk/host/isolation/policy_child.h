// The program of a policy's own process: karst-policy-child, started only by PolicyProcess.
#pragma once
namespace karst::host {

constexpr int kRequestsDescriptor = 3;  // the host's memory, read-only
constexpr int kAnswersDescriptor = 4;   // this process's

/// Confines the process, opens the plugin and serves the host until its message `end`. Returns the exit code.
int serve_policy();

}  // namespace karst::host
