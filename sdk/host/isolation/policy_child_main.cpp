#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "sdk/host/isolation/policy_child.h"

int main(int argc, char** argv) {
  // The kernel ends this process when the host's thread that started it ends, for whatever reason: it needs
  // no cooperation of this process, and nothing in it can prevent it. If the host has ended before this line,
  // the parent process is another one by now.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (argc != 2 || std::atoi(argv[1]) != getppid()) {
    std::fputs("karst-policy-child is started by karst, for policy.isolation = process\n", stderr);
    return 1;
  }
  // A line that the policy prints goes out at once, as on a terminal: what comes before a crash must not be
  // lost.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  int code = 1;
  try {
    code = karst::host::serve_policy();
  } catch (const std::exception&) {  // the host sees that this process has ended
  }
  std::fflush(stdout);
  _exit(code);  // threads of the policy may still run, so nothing is destroyed
}
