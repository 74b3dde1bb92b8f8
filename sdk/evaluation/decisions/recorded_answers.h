// The policy's answers as the host recorded them in requests.bin.
#pragma once
#include <filesystem>
#include <functional>

#include "sdk/evaluation/decisions/ranked_goals.h"

namespace karst::evaluation {

/// The record of requests in a run directory; there only after `karst fly --record-requests`.
std::filesystem::path requests_file(const std::filesystem::path& run_dir);

/// Hands over the answers in the file's order until `visit` returns false. Throws core::InputError if the
/// file is damaged, after what stands before the damage.
void for_each_answer(const std::filesystem::path& requests,
                     const std::function<bool(const RecordedAnswer&)>& visit);

}  // namespace karst::evaluation
