// Whether ground truth that was written elsewhere is of a flight. Nothing in it names the flight: the seed,
// the start and the length of the path are compared.
#pragma once
#include <filesystem>

namespace karst::flight {

/// `truth`: a folder of `karst vehicle serve --truth`. Throws core::InputError with the difference if another
/// flight was recorded there. Two flights of one seed in real time that begin at one place and fly
/// equally far cannot be told apart.
void check_same_flight(const std::filesystem::path& run_dir, const std::filesystem::path& truth);

}  // namespace karst::flight
