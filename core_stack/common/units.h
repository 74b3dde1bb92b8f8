// Units a mission file may use.
#pragma once
#include <optional>
#include <string_view>

namespace karst::core {

/// Factor that turns a value in `from` into `to`; none if they are not of one dimension.
std::optional<double> unit_factor(std::string_view from, std::string_view to);

}  // namespace karst::core
