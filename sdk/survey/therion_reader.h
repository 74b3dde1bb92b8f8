// Therion's survey files (.th). Drawings, maps and surfaces in them are skipped.
//
// Source: M. Budaj and S. Mudrak, The Therion Book, "Creating data files".
#pragma once
#include <string>

#include "sdk/survey/readings.h"

namespace karst::survey {

/// Throws core::InputError naming file, line and reason where the file cannot be read. What Therion only
/// warns of, what is guessed and what is left out becomes a note.
Readings read_therion(const std::string& file);

}  // namespace karst::survey
