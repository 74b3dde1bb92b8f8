// What Survex's programs print: text of dump3d, .err files, messages of cavern.
#include "sdk/survey/cavern.h"
#include "sdk/survey/dump3d.h"
#include "sdk/survey/err_file.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".txt", [&](const std::string& path) {
    karst::survey::cavern_messages(std::string(reinterpret_cast<const char*>(data), size));
    karst::survey::read_err_file(path);
    karst::survey::read_dump3d(path, path);
  });
}
