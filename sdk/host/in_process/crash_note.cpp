#include "sdk/host/in_process/crash_note.h"

#include <unistd.h>

#include <memory>
#include <mutex>
#include <utility>

#include "core_stack/common/sanitized.h"

namespace karst::host {
namespace {

constexpr std::array kFatalSignals{SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};

/// For the handler after a stack overflow. The kernel saves all registers there, which takes up to 11 kB.
constexpr std::size_t kAlternateStackBytes = 64 * 1024;

/// A signal handler gets no argument of ours: the thread that crashes finds its note here.
thread_local CrashNote* innermost_note = nullptr;

const char* name_of_signal(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV";
    case SIGABRT:
      return "SIGABRT";
    case SIGBUS:
      return "SIGBUS";
    case SIGFPE:
      return "SIGFPE";
    default:
      return "SIGILL";
  }
}

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

/// Async-signal-safe. The signal raised again is blocked until this returns; then it ends the process.
void on_fatal_signal(int signal) {
  if (innermost_note != nullptr) innermost_note->write(signal);
  set_handler(signal, SIG_DFL);
  ::raise(signal);
}

bool has_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == handler;
}

/// Of all threads: the process has one handler for each signal.
struct NotesInProcess {
  std::mutex mutex;
  int count = 0;
};
NotesInProcess& notes_in_process() {
  static NotesInProcess notes;
  return notes;
}

/// Where the handlers are `from`, they become `to`.
void exchange_handlers(void (*from)(int), void (*to)(int)) {
  for (const int signal : kFatalSignals)
    if (has_handler(signal, from)) set_handler(signal, to);
}

stack_t alternate_stack_of_thread() {
  thread_local const std::unique_ptr<std::byte[]> bytes = std::make_unique<std::byte[]>(kAlternateStackBytes);
  stack_t stack{};
  stack.ss_sp = bytes.get();
  stack.ss_size = kAlternateStackBytes;
  return stack;
}

}  // namespace

CrashNote::CrashNote(std::string_view text) {
  if (kSanitized || text.empty()) return;
  const stack_t stack = alternate_stack_of_thread();
  size_ = text.copy(line_.data(), kMaxText);
  for (const char c : {' ', '('}) line_[size_++] = c;
  active_ = true;
  outer_ = std::exchange(innermost_note, this);
  ::sigaltstack(&stack, &stack_before_);
  NotesInProcess& notes = notes_in_process();
  const std::lock_guard lock(notes.mutex);
  if (notes.count++ == 0) exchange_handlers(SIG_DFL, &on_fatal_signal);
}

CrashNote::~CrashNote() {
  if (!active_) return;
  {
    NotesInProcess& notes = notes_in_process();
    const std::lock_guard lock(notes.mutex);
    if (--notes.count == 0) exchange_handlers(&on_fatal_signal, SIG_DFL);
  }
  ::sigaltstack(&stack_before_, nullptr);
  innermost_note = outer_;
}

void CrashNote::write(int signal) {
  for (const char* c = name_of_signal(signal); *c != '\0'; ++c) line_[size_++] = *c;
  for (const char c : {')', '\n'}) line_[size_++] = c;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line_.data(), size_);
}

}  // namespace karst::host
