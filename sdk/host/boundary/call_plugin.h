// Calls a slot of a plugin's table.
#pragma once
#include <type_traits>

namespace karst::host {

/// Calls `f`, which the ABI declares noexcept. A plugin that breaks that promise from C, or from a standard
/// that cannot state it, must not terminate the process: through this pointer type the exception can be
/// caught.
template <class R, class... Args>
R call_plugin(R (*f)(Args...), std::type_identity_t<Args>... args) {
  return f(args...);
}

}  // namespace karst::host
