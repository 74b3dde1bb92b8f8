// A mutex and a condition for threads of different priorities.
//
// The loop of a flight in real time shares a queue with threads of lower priority. With a usual mutex, one
// that is preempted while it holds the mutex keeps the loop waiting for as long as others run (priority
// inversion). With priority inheritance the holder runs at the priority of who waits.
#pragma once
#include <pthread.h>

namespace karst::core {

/// Meets BasicLockable and Lockable: std::lock_guard and std::unique_lock work with it.
class InheritingMutex {
 public:
  InheritingMutex() {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
    pthread_mutex_init(&mutex_, &attributes);
    pthread_mutexattr_destroy(&attributes);
  }
  ~InheritingMutex() { pthread_mutex_destroy(&mutex_); }
  InheritingMutex(const InheritingMutex&) = delete;
  InheritingMutex& operator=(const InheritingMutex&) = delete;

  void lock() { pthread_mutex_lock(&mutex_); }
  bool try_lock() { return pthread_mutex_trylock(&mutex_) == 0; }
  void unlock() { pthread_mutex_unlock(&mutex_); }
  pthread_mutex_t* native_handle() { return &mutex_; }

 private:
  pthread_mutex_t mutex_;
};

class Condition {
 public:
  Condition() { pthread_cond_init(&condition_, nullptr); }
  ~Condition() { pthread_cond_destroy(&condition_); }
  Condition(const Condition&) = delete;
  Condition& operator=(const Condition&) = delete;

  void notify_one() { pthread_cond_signal(&condition_); }
  /// The calling thread holds `mutex`.
  template <class Holds>
  void wait(InheritingMutex& mutex, Holds holds) {
    while (!holds()) pthread_cond_wait(&condition_, mutex.native_handle());
  }

 private:
  pthread_cond_t condition_;
};

}  // namespace karst::core
