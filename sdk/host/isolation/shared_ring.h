// Two rings of bytes in shared memory, one each way, between the host and a policy's process.
//
// Each end owns one piece of memory that it alone writes: the bytes it sends, how many it has sent, and how
// many it has read of the other's. The policy's process has the host's mapped read-only, by a descriptor that
// cannot be used to write. Whoever waits sleeps on the other end's count (futex).
//
// Nothing that stands there is trusted: a count is read once, checked, and bytes are copied before they are
// looked at.
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "sdk/host/serialization/flat_bytes.h"

namespace karst::host {

/// The other end does not answer any more, or wrote what cannot be. `what()` is for the log.
struct RingBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One kind of message, and what it says.
struct RingMessage {
  std::uint32_t kind = 0;
  Bytes body;
};

/// The memory of one end, as the other maps it. Unmapped, and its descriptor closed, with the object.
class RingMemory {
 public:
  enum class Access { read, write };

  /// New memory, to be written.
  RingMemory();
  /// Memory that is there: `descriptor`, which is closed with this object.
  RingMemory(int descriptor, Access access);
  ~RingMemory();
  RingMemory(const RingMemory&) = delete;
  RingMemory& operator=(const RingMemory&) = delete;

  std::byte* data() const { return data_; }
  int descriptor() const { return descriptor_; }
  /// Another descriptor of the same memory that can only be read, closed on exec. To be closed by the caller.
  int read_only_descriptor() const;
  void close_descriptor();

 private:
  int descriptor_ = -1;
  std::byte* data_ = nullptr;
};

class RingEnd {
 public:
  /// Called every few milliseconds while the other end is waited for; throws to give it up.
  using Watch = std::function<void()>;

  RingEnd(const RingMemory& own, const RingMemory& other, Watch watch);

  /// Returns when all of it is in the ring. Throws what `watch` throws, and RingBroken.
  void send(std::uint32_t kind, std::span<const std::byte> body);
  /// Throws what `watch` throws, and RingBroken, also for a message of more than `max_bytes`.
  RingMessage receive(std::size_t max_bytes);

 private:
  void write(std::span<const std::byte> bytes);
  void read(std::span<std::byte> bytes);

  std::byte *own_, *other_;
  std::uint32_t written_ = 0, read_ = 0;  // never taken from the shared memory
  Watch watch_;
};

}  // namespace karst::host
