// Bad input is reported with the file, the place in it, and the reason: something a user can act on.
#pragma once
#include <stdexcept>
#include <string>

namespace karst::core {

/// Thrown while setting up; in flight it has the vehicle land where it is. `what()` reads "file: place:
/// reason".
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& file, const std::string& place, const std::string& reason)
      : std::runtime_error(file + ": " + (place.empty() ? "" : place + ": ") + reason) {}
  /// The same error, and `more` about it.
  InputError(const InputError& error, const std::string& more) : std::runtime_error(error.what() + more) {}
};

}  // namespace karst::core
