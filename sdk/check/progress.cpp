#include "sdk/check/progress.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core_stack/common/error.h"

namespace karst::check {

Progress::Progress(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  const bool good = descriptor >= 0 && ftruncate(descriptor, sizeof(Shared)) == 0;
  void* memory =
      good ? mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0) : MAP_FAILED;
  const int error = errno;
  if (descriptor >= 0) close(descriptor);
  if (memory == MAP_FAILED) throw core::InputError(file.string(), "", std::strerror(error));
  shared_ = static_cast<Shared*>(memory);
}

Progress::~Progress() { munmap(shared_, sizeof(Shared)); }

void Progress::enter(const std::string& what) {
  const std::size_t n = std::min(what.size(), sizeof shared_->what - 1);
  std::memcpy(shared_->what, what.data(), n);
  shared_->what[n] = '\0';
  ++shared_->count;
}

void Progress::leave() { ++shared_->count; }

std::uint64_t Progress::count() const { return shared_->count; }

std::string Progress::what() const { return {shared_->what, strnlen(shared_->what, sizeof shared_->what)}; }

}  // namespace karst::check
