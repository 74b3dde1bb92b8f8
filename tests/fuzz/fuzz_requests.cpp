#include "sdk/host/request_log.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".bin", [](const std::string& path) {
    karst::host::RequestLogReader log(path);
    while (log.next() != karst::host::RequestLogReader::Kind::end) continue;
  });
}
