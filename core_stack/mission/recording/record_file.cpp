#include "core_stack/mission/recording/record_file.h"

#include "core_stack/common/error.h"

namespace karst::core {

void RecordFile::open(const std::filesystem::path& path, DiskWriter* disk) {
  if (disk) {
    file_ = disk->open(path);
    disk_ = disk;
    return;
  }
  out_.open(path, std::ios::binary | std::ios::trunc);
  if (!out_) throw InputError(path.string(), "", "cannot be written");
}

RecordFile& RecordFile::operator<<(std::string_view bytes) {
  empty_ = false;
  if (disk_)
    buffer_ += bytes;
  else
    out_ << bytes;
  return *this;
}

bool RecordFile::flush() {
  if (disk_) return disk_->try_append(file_, buffer_);
  if (!out_.is_open()) return true;
  out_.flush();
  return out_.good();
}

bool RecordFile::close() { return disk_ ? disk_->append(file_, buffer_) : flush(); }

}  // namespace karst::core
