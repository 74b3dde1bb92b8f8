#include "sdk/evaluation/record/whole_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/output_file.h"

namespace karst::evaluation {

namespace fs = std::filesystem;

void write_whole_file(const fs::path& file, std::string_view bytes) {
  std::error_code ignored, error;
  const bool device =
      fs::exists(file, ignored) && fs::is_other(file, ignored);  // /dev/stdout: nothing to rename onto
  const fs::path part = device ? file : fs::path(file.string() + ".part");
  // First remove leftovers of a killed run, a FIFO, which would block, or a link, which would lead elsewhere.
  if (!device && !fs::is_directory(part, ignored)) fs::remove(part, ignored);
  errno = 0;
  std::ofstream out =
      device ? core::open_output(part) : std::ofstream(part, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out && !device) fs::rename(part, file, error);
  if (out && !error) return;
  const std::string reason = error ? error.message() : std::strerror(errno);
  if (!device) fs::remove(part, ignored);
  throw core::InputError(file.string(), "", "cannot be written: " + reason);
}

}  // namespace karst::evaluation
