#include "core_stack/common/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core_stack/common/error.h"

namespace karst::core {

std::ofstream open_output(const std::string& file) {
  const auto fail = [&] {
    const std::string reason =
        errno == ENXIO ? "is a FIFO that nobody reads, or a socket" : std::strerror(errno);
    throw InputError(file, "", "cannot be written: " + reason);
  };
  const int tried = open(file.c_str(), O_WRONLY | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
  if (tried < 0) fail();
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  const int error = errno;
  close(tried);
  errno = error;
  if (!out) fail();
  return out;
}

}  // namespace karst::core
