// Two ends of the rings in one process, on two threads; and an end that writes what it must not.
#include "sdk/host/isolation/shared_ring.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <thread>

namespace karst::test {
namespace {

using host::Bytes;
using host::RingEnd;
using host::RingMemory;

constexpr std::size_t kMax = 8u << 20;

Bytes pattern(std::size_t size, unsigned seed) {
  Bytes out(size);
  for (std::byte& b : out) b = static_cast<std::byte>((seed = seed * 1664525u + 1013904223u) >> 24);
  return out;
}

TEST(SharedRing, MessagesOfAnySizeArriveInOrder) {
  RingMemory a, b;
  const std::vector<std::size_t> sizes = {0, 1, 4095, 1u << 20, (1u << 20) + 1, 3'333'333, 7};
  std::thread echo([&] {
    RingEnd end(b, a, [] {});
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const host::RingMessage m = end.receive(kMax);
      end.send(m.kind + 1, m.body);
    }
  });
  RingEnd end(a, b, [] {});
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Bytes sent = pattern(sizes[i], static_cast<unsigned>(i));
    end.send(static_cast<std::uint32_t>(i), sent);
    const host::RingMessage m = end.receive(kMax);
    EXPECT_EQ(m.kind, i + 1);
    EXPECT_TRUE(m.body == sent) << sizes[i];
  }
  echo.join();
}

TEST(SharedRing, TheWatchEndsAWaitThatNobodyAnswers) {
  struct Enough {};
  RingMemory a, b;
  int waits = 0;
  RingEnd end(a, b, [&] {
    if (++waits == 3) throw Enough{};
  });
  EXPECT_THROW(end.receive(kMax), Enough);
  waits = 0;
  EXPECT_THROW(end.send(1, Bytes(2u << 20)), Enough);  // more than the ring holds
}

TEST(SharedRing, GarbageInTheOtherEndsMemoryIsRefusedOrReadAsBytes) {
  struct Enough {};
  for (unsigned seed = 0; seed < 300; ++seed) {
    RingMemory a, b;
    const Bytes noise = pattern(8192, seed);
    std::memcpy(b.data(), noise.data(), noise.size());
    int waits = 0;
    RingEnd end(a, b, [&] {
      if (++waits == 2) throw Enough{};
    });
    try {
      const host::RingMessage m = end.receive(kMax);
      EXPECT_LE(m.body.size(), kMax);
    } catch (const host::RingBroken&) {
    } catch (const Enough&) {
    }
  }
}

TEST(SharedRing, AMessageTooLongIsRefusedBeforeMemoryIsTakenForIt) {
  RingMemory a, b;
  RingEnd sender(b, a, [] {}), receiver(a, b, [] {});
  sender.send(1, Bytes(1001));
  EXPECT_THROW(receiver.receive(1000), host::RingBroken);
}

TEST(SharedRing, TheReadOnlyDescriptorCannotBeWrittenThrough) {
  RingMemory a;
  const int reader = a.read_only_descriptor();
  EXPECT_EQ(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, reader, 0), MAP_FAILED);
  void* seen = mmap(nullptr, 4096, PROT_READ, MAP_SHARED, reader, 0);
  ASSERT_NE(seen, MAP_FAILED);
  EXPECT_EQ(mprotect(seen, 4096, PROT_READ | PROT_WRITE), -1);
  EXPECT_EQ(ftruncate(reader, 0), -1);
  EXPECT_EQ(ftruncate(a.descriptor(), 0), -1);  // nor cut short by anybody
  munmap(seen, 4096);
  close(reader);
}

}  // namespace
}  // namespace karst::test
