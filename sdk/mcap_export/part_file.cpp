#include "sdk/mcap_export/part_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/output_file.h"

namespace karst::mcap {
namespace {

namespace fs = std::filesystem;

bool is_device(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) && fs::is_other(file, ignored);
}

}  // namespace

PartFile::PartFile(fs::path file)
    : file_(std::move(file)),
      device_(is_device(file_)),
      part_(device_ ? file_ : fs::path(file_.string() + ".part")) {
  std::error_code ignored;
  // What a killed run left, a FIFO, which would block, or a link, which would lead elsewhere.
  if (!device_ && !fs::is_directory(part_, ignored)) fs::remove(part_, ignored);
  errno = 0;
  if (device_)
    out_ = core::open_output(part_.string());
  else
    out_.open(part_, std::ios::binary | std::ios::trunc);
  if (!out_) fail(std::strerror(errno));
}

PartFile::~PartFile() {
  if (done_ || device_) return;
  out_.close();
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void PartFile::check() {
  if (!out_) fail(errno != 0 ? std::strerror(errno) : "a write failed");
}

void PartFile::commit() {
  out_.flush();
  check();
  out_.close();
  check();
  std::error_code error;
  if (!device_) fs::rename(part_, file_, error);
  if (error) fail(error.message());
  done_ = true;
}

void PartFile::fail(const std::string& reason) {
  throw core::InputError(file_.string(), "", "cannot be written: " + reason);
}

}  // namespace karst::mcap
