// Calls a slot of a plugin's table.
#pragma once
#include <type_traits>

namespace karst::host {

/// Calls `f`, which the ABI declares noexcept. A plugin that breaks that promise, compiled as C or an older
/// C++ standard without noexcept types, must not terminate the process: a call through this pointer type lets
/// the caller catch the exception.
template <class R, class... Args>
R call_plugin(R (*f)(Args...), std::type_identity_t<Args>... args) {
  return f(args...);
}

}  // namespace karst::host
