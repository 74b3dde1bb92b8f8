// Two ring buffers in shared memory, one for each direction, between the host and a policy's process.
//
// Each end owns one piece of memory that it alone writes: the bytes it sends, how many it has sent, and how
// many it has read from the other end. The policy's process maps the host's memory read-only, by a descriptor
// that does not permit writing. A waiting end sleeps on the other end's count (futex).
//
// Data in shared memory is not trusted: a count is read once and checked, and bytes are copied before they
// are parsed.
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "sdk/host/serialization/flat_bytes.h"

namespace karst::host {

/// The other end no longer answers, or wrote invalid data. `what()` is for the log.
struct RingBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The kind and the body of a message.
struct RingMessage {
  std::uint32_t kind = 0;
  Bytes body;
};

/// The memory of one end, which the other end maps. The destructor unmaps it and closes its descriptor.
class RingMemory {
 public:
  enum class Access { read, write };

  /// Creates new, writable memory.
  RingMemory();
  /// Maps existing memory: `descriptor`, which is closed with this object.
  RingMemory(int descriptor, Access access);
  ~RingMemory();
  RingMemory(const RingMemory&) = delete;
  RingMemory& operator=(const RingMemory&) = delete;

  std::byte* data() const { return data_; }
  int descriptor() const { return descriptor_; }
  /// Another descriptor of the same memory, read-only and close-on-exec. The caller must close it.
  int read_only_descriptor() const;
  void close_descriptor();

 private:
  int descriptor_ = -1;
  std::byte* data_ = nullptr;
};

class RingEnd {
 public:
  /// Called every few milliseconds while waiting for the other end; throws to stop waiting.
  using Watch = std::function<void()>;

  RingEnd(const RingMemory& own, const RingMemory& other, Watch watch);

  /// Returns when the whole message is in the ring. Throws RingBroken, and passes on exceptions of `watch`.
  void send(std::uint32_t kind, std::span<const std::byte> body);
  /// Throws RingBroken, also for a message of more than `max_bytes`, and passes on exceptions of `watch`.
  RingMessage receive(std::size_t max_bytes);

 private:
  void write(std::span<const std::byte> bytes);
  void read(std::span<std::byte> bytes);

  std::byte *own_, *other_;
  std::uint32_t written_ = 0, read_ = 0;  // private copies, never read back from shared memory
  Watch watch_;
};

}  // namespace karst::host
