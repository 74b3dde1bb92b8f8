// A file descriptor that is closed when it goes out of scope; -1: none.
#pragma once
#include <unistd.h>

namespace karst::host {

struct Descriptor {
  int value;
  explicit Descriptor(int d) : value(d) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value >= 0) close(value);
  }
};

}  // namespace karst::host
