#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "sdk/host/isolation/policy_child.h"

int main(int argc, char** argv) {
  // The kernel ends this process when the host's thread that started it ends, however that comes about:
  // nothing in this process has to see to it, and nothing in it can stop it. If the host has ended before
  // this line, the parent is another by now.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (argc != 2 || std::atoi(argv[1]) != getppid()) {
    std::fputs("karst-policy-child is started by karst, for policy.isolation = process\n", stderr);
    return 1;
  }
  int code = 1;
  try {
    code = karst::host::serve_policy();
  } catch (const std::exception&) {  // the host sees that this process has ended
  }
  _exit(code);  // threads of the policy may still run: nothing is torn down
}
