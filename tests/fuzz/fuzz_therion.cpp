// A survey of Therion: refused with an InputError, or read. Whatever it inputs, it finds in the file's
// folder.
#include "sdk/survey/network.h"
#include "sdk/survey/therion_reader.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return karst::fuzz::read_as_file(data, size, ".th", [](const std::string& path) {
    karst::survey::Readings readings = karst::survey::read_therion(path);
    const karst::survey::Network network = karst::survey::network_of(readings);
    for (const std::uint32_t leg : network.legs)
      if (network.place.at(readings.legs.at(leg).from) >= network.stations.size()) std::abort();
  });
}
