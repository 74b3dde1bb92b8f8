/* Has a thread make a system call of the x32 interface, which filters made for x86-64 alone let by. */
#define _GNU_SOURCE
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

static void* call(void* unused) {
  (void)unused;
  syscall(0x40000000 | SYS_getpid);
  return 0;
}
static void call_on_a_thread(void) {
  pthread_t thread;
  if (pthread_create(&thread, 0, call, 0) == 0) pthread_join(thread, 0);
}
#define DECIDE                          \
  const karst_goal_t g = goal_ahead(r); \
  (void)self;                           \
  call_on_a_thread();                   \
  return answer(sink, &g, 1, error);
#include "plain.h"
