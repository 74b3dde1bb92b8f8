#include "sdk/evaluation/whole_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core_stack/common/error.h"

namespace karst::evaluation {

void write_whole_file(const std::filesystem::path& file, std::string_view bytes) {
  const std::filesystem::path part = file.string() + ".part";
  errno = 0;
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(part, file, error);
  if (out && !error) return;
  const std::string reason = error ? error.message() : std::strerror(errno);
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw core::InputError(file.string(), "", "cannot be written: " + reason);
}

}  // namespace karst::evaluation
