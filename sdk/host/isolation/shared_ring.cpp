#include "sdk/host/isolation/shared_ring.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "core_stack/common/error.h"

namespace karst::host {
namespace {

constexpr std::size_t kCapacity = 1u << 20, kDataAt = 4096, kSize = kDataAt + kCapacity;
constexpr long kSlice_ns = 5'000'000;

/// At the start of each end's memory; counts wrap around modulo 2^32.
struct Counts {
  alignas(64) std::atomic<std::uint32_t> written;  // bytes this end has sent
  alignas(64) std::atomic<std::uint32_t> read;     // bytes it has taken from the other end
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free && sizeof(Counts) <= kDataAt);

Counts& counts(std::byte* memory) { return *reinterpret_cast<Counts*>(memory); }

void wake(std::atomic<std::uint32_t>& word) { syscall(SYS_futex, &word, FUTEX_WAKE, 1, nullptr, nullptr, 0); }
/// Sleeps while the word equals `seen`, for at most one time slice.
void sleep_on(std::atomic<std::uint32_t>& word, std::uint32_t seen) {
  const timespec slice{0, kSlice_ns};
  syscall(SYS_futex, &word, FUTEX_WAIT, seen, &slice, nullptr, 0);
}

[[noreturn]] void no_memory(const char* what) {
  throw core::InputError("a policy's process", "", std::string(what) + ": " + std::strerror(errno));
}

}  // namespace

RingMemory::RingMemory() : descriptor_(memfd_create("karst-policy", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (descriptor_ < 0) no_memory("no shared memory can be had");
  // A file beyond the user's limit (ulimit -f) comes with a signal that ends the process: never tried.
  rlimit files{};
  if (getrlimit(RLIMIT_FSIZE, &files) == 0 && files.rlim_cur < kSize) {
    close(descriptor_);
    errno = EFBIG;
    no_memory("no shared memory can be had");
  }
  // Sealed, because reading memory that the other end has truncated would end this process.
  if (ftruncate(descriptor_, kSize) != 0 ||
      fcntl(descriptor_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    close(descriptor_);
    no_memory("no shared memory can be had");
  }
  void* at = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (at == MAP_FAILED) {
    close(descriptor_);
    no_memory("shared memory cannot be mapped");
  }
  data_ = static_cast<std::byte*>(at);
}

RingMemory::RingMemory(int descriptor, Access access) : descriptor_(descriptor) {
  const int protection = access == Access::write ? PROT_READ | PROT_WRITE : PROT_READ;
  void* at = mmap(nullptr, kSize, protection, MAP_SHARED, descriptor_, 0);
  if (at == MAP_FAILED) no_memory("shared memory cannot be mapped");
  data_ = static_cast<std::byte*>(at);
}

RingMemory::~RingMemory() {
  munmap(data_, kSize);
  close_descriptor();
}

void RingMemory::close_descriptor() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

int RingMemory::read_only_descriptor() const {
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor_);
  const int reader = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (reader < 0) no_memory("shared memory cannot be opened for reading");
  return reader;
}

RingEnd::RingEnd(const RingMemory& own, const RingMemory& other, Watch watch)
    : own_(own.data()), other_(other.data()), watch_(std::move(watch)) {}

void RingEnd::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::uint32_t taken = counts(other_).read.load(std::memory_order_acquire);
    const std::uint32_t under_way = written_ - taken;
    if (under_way > kCapacity) throw RingBroken("it claims to have read what was never sent");
    const std::size_t room = kCapacity - under_way;
    if (room == 0) {
      watch_();
      sleep_on(counts(other_).read, taken);
      continue;
    }
    const std::size_t at = written_ % kCapacity, n = std::min({room, bytes.size(), kCapacity - at});
    std::memcpy(own_ + kDataAt + at, bytes.data(), n);
    written_ += static_cast<std::uint32_t>(n);
    counts(own_).written.store(written_, std::memory_order_release);
    wake(counts(own_).written);
    bytes = bytes.subspan(n);
  }
}

void RingEnd::read(std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const std::uint32_t sent = counts(other_).written.load(std::memory_order_acquire);
    const std::uint32_t waiting = sent - read_;
    if (waiting > kCapacity) throw RingBroken("it claims to have sent more than the ring holds");
    if (waiting == 0) {
      watch_();
      sleep_on(counts(other_).written, sent);
      continue;
    }
    const std::size_t at = read_ % kCapacity,
                      n = std::min({static_cast<std::size_t>(waiting), bytes.size(), kCapacity - at});
    std::memcpy(bytes.data(), other_ + kDataAt + at, n);
    read_ += static_cast<std::uint32_t>(n);
    counts(own_).read.store(read_, std::memory_order_release);
    wake(counts(own_).read);
    bytes = bytes.subspan(n);
  }
}

void RingEnd::send(std::uint32_t kind, std::span<const std::byte> body) {
  FlatWriter head;
  head.put(kind);
  head.put<std::uint64_t>(body.size());
  write(head.bytes());
  write(body);
}

RingMessage RingEnd::receive(std::size_t max_bytes) {
  Bytes head(sizeof(std::uint32_t) + sizeof(std::uint64_t));
  read(head);
  FlatReader in(head);
  RingMessage message{in.number<std::uint32_t>(), {}};
  const auto size = in.number<std::uint64_t>();
  if (size > max_bytes) throw RingBroken("it sent a message of " + std::to_string(size) + " bytes");
  // Memory is allocated as bytes arrive, not as they are announced.
  while (message.body.size() < size) {
    const std::size_t before = message.body.size();
    message.body.resize(std::min<std::size_t>(size, before + kCapacity));
    read(std::span(message.body).subspan(before));
  }
  return message;
}

}  // namespace karst::host
