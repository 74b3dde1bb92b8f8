// A fresh folder with files for a test.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include "core_stack/common/temporary_folder.h"

namespace karst::test {

class Folder : public core::TemporaryFolder {
 public:
  Folder() : TemporaryFolder("test") {}
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path() / name, std::ios::binary) << bytes;
    return (path() / name).string();
  }
};

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace karst::test
