/*
 * Wants to go on when the host is gone: puts every other thread of its process to sleep for good, such as one
 * that would look whether the parent is still there, and changes what a signal on the parent's death would
 * be.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static void sleep_for_good(int signal) {
  const struct timespec hour = {3600, 0};
  (void)signal;
  for (;;) nanosleep(&hour, 0);
}
static void outlive(void) {
  const long self = syscall(SYS_gettid), process = getpid();
  DIR* const threads = opendir("/proc/self/task");
  signal(SIGUSR1, sleep_for_good);
  prctl(PR_SET_PDEATHSIG, 0);
  for (struct dirent* d; threads && (d = readdir(threads));) {
    const long thread = atol(d->d_name);
    /* The first thread waits for this one: it may sleep after the answer. */
    if (thread > 0 && thread != self && thread != process) syscall(SYS_tgkill, process, thread, SIGUSR1);
  }
  if (threads) closedir(threads);
}
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  outlive();                            \
  return answer(sink, &g, 1, error);
#include "plain.h"
