/*
 * Tries what a policy has no business with, and says in its goal what it was let do. Nothing it tries harms
 * if it is let: the file it opens to write is /dev/null, the signal is 0.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

static char said[200];
static void note(const char* what, int let) {
  strcat(said, what);
  strcat(said, let ? "+ " : "- ");
}
static int let_open(const char* path, int flags) {
  const int f = open(path, flags);
  if (f >= 0) close(f);
  return f >= 0;
}
static int let_socket(int family) {
  const int f = socket(family, SOCK_STREAM, 0);
  if (f >= 0) close(f);
  return f >= 0;
}
static int let_raise_limit(void) {
  const struct rlimit all = {RLIM_INFINITY, RLIM_INFINITY};
  return setrlimit(RLIMIT_NOFILE, &all) == 0;
}
static void try_all(void) {
  char parent[64];
  said[0] = 0;
  note("own", let_open("/proc/self/maps", O_RDONLY));
  note("library", let_open("/usr/lib/os-release", O_RDONLY));
  snprintf(parent, sizeof parent, "/proc/%d/maps", (int)getppid());
  note("parent", let_open(parent, O_RDONLY));
  note("etc", let_open("/etc/passwd", O_RDONLY) || let_open("/etc/shadow", O_RDONLY));
  note("list", let_open("/", O_RDONLY | O_DIRECTORY));
  note("write", let_open("/dev/null", O_WRONLY));
  note("create", mkdir("/tmp/karst_reaching_out", 0700) == 0 && rmdir("/tmp/karst_reaching_out") == 0);
  note("inet", let_socket(AF_INET));
  note("unix", let_socket(AF_UNIX));
  note("signal", kill(getppid(), 0) == 0);
  execl("/no/such/program", "", (char*)0);
  note("exec", errno == ENOENT); /* it was looked for */
  note("limit", let_raise_limit());
}
#define DECIDE                    \
  karst_goal_t g = goal_ahead(r); \
  (void)self;                     \
  try_all();                      \
  g.why.data = said;              \
  g.why.length = strlen(said);    \
  return answer(sink, &g, 1, error);
#include "plain.h"
