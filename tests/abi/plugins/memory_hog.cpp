// Asks for more memory than there is: the allocation fails, and the C++ face turns it into an error.
#include <karst/policy.h>

#include <limits>

namespace {
class MemoryHog : public karst::Policy {
  karst::Decision decide(const karst::Request&) override {
    std::vector<char> all(static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max() / 2));
    return karst::Decision::hold(std::string(1, all[0]));
  }
};
}  // namespace
KARST_POLICY(MemoryHog, "memory_hog", "1.0.0", "Wants it all.")
