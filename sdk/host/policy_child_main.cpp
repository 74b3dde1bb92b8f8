#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "sdk/host/policy_child.h"

int main(int argc, char** argv) {
  if (argc != 2 || std::atoi(argv[1]) != getppid()) {
    std::fputs("karst-policy-child is started by karst, for policy.isolation = process\n", stderr);
    return 1;
  }
  int code = 1;
  try {
    code = karst::host::serve_policy(getppid());
  } catch (const std::exception&) {  // the host sees that this process has ended
  }
  _exit(code);  // threads of the policy may still run: nothing is torn down
}
