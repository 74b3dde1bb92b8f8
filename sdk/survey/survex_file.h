// Writes readings as Survex reads them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sdk/survey/network.h"
#include "sdk/survey/readings.h"

namespace karst::survey {

/// The name of a place: three numbers below a hundred and the rest, since cavern searches the stations of a
/// survey one after the other.
std::string place_name(std::uint32_t place);
std::optional<std::uint32_t> place_of_name(std::string_view name);

/// Writes the legs of the network, with the standard deviations that were given, and the fixes at these
/// positions. Returns where each line of it comes from.
std::vector<Source> write_survex(const std::string& file, const Readings& readings, const Network& network,
                                 const std::vector<core::Vec3>& fixes_m);

}  // namespace karst::survey
