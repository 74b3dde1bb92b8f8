// The elementary functions of core_stack/common/elementary_functions.c against the x87 unit's long doubles.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core_stack/common/random.h"

namespace karst::test {
namespace {

struct Function {
  std::string name;
  double low, high;
  std::function<double(double)> f;
  std::function<long double(long double)> reference;
};

#define KARST_FUNCTION(name, low, high)                                                                      \
  Function {                                                                                                 \
#name, low, high, [](double x) { return name(x); },                                                      \
                                                     [](long double x) -> long double { return name##l(x); } \
  }

std::vector<Function> functions() {
  return {
      KARST_FUNCTION(sin, -1e4, 1e4),
      KARST_FUNCTION(cos, -1e4, 1e4),
      KARST_FUNCTION(tan, -100, 100),
      KARST_FUNCTION(asin, -1, 1),
      KARST_FUNCTION(acos, -1, 1),
      KARST_FUNCTION(atan, -50, 50),
      KARST_FUNCTION(sinh, -20, 20),
      KARST_FUNCTION(cosh, -20, 20),
      KARST_FUNCTION(tanh, -20, 20),
      KARST_FUNCTION(asinh, -50, 50),
      KARST_FUNCTION(acosh, 1, 50),
      KARST_FUNCTION(atanh, -1, 1),
      KARST_FUNCTION(exp, -300, 300),
      KARST_FUNCTION(exp2, -300, 300),
      KARST_FUNCTION(expm1, -20, 20),
      KARST_FUNCTION(log, 1e-12, 1e6),
      KARST_FUNCTION(log2, 1e-12, 1e6),
      KARST_FUNCTION(log10, 1e-12, 1e6),
      KARST_FUNCTION(log1p, -0.9, 100),
      KARST_FUNCTION(cbrt, -1e6, 1e6),
      KARST_FUNCTION(erf, -4, 4),
      KARST_FUNCTION(erfc, -4, 4),
      KARST_FUNCTION(tgamma, 0.1, 20),
      {"atan2", -10, 10, [](double x) { return atan2(x, 0.7 - x * x); },
       [](long double x) { return atan2l(x, static_cast<long double>(0.7 - static_cast<double>(x * x))); }},
      {"pow", 1e-3, 1e3, [](double x) { return pow(x, 1.75); }, [](long double x) { return powl(x, 1.75L); }},
      {"hypot", -1e3, 1e3, [](double x) { return hypot(x, 3.25); },
       [](long double x) { return hypotl(x, 3.25L); }}};
}

double ulp(double x) {
  return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x);
}

TEST(ElementaryFunctions, AreWithinTwoUnitsInTheLastPlace) {
  for (const Function& f : functions()) {
    core::Random random(7);
    for (int i = 0; i < 20000; ++i) {
      const double x = random.uniform(f.low, f.high);
      const auto expected = static_cast<double>(f.reference(x));
      ASSERT_LE(std::abs(f.f(x) - expected), 2 * ulp(expected)) << f.name << " of " << x;
    }
  }
}

TEST(ElementaryFunctions, KeepWhatCodeReliesOnAtTheEdges) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sin(0.0), 0);
  EXPECT_TRUE(std::signbit(sin(-0.0)));
  EXPECT_EQ(cos(0.0), 1);
  EXPECT_EQ(acos(1.0), 0);
  EXPECT_TRUE(std::isnan(acos(1.0000001)));
  EXPECT_TRUE(std::isnan(sin(inf)));
  EXPECT_EQ(exp(0.0), 1);
  EXPECT_EQ(exp(-inf), 0);
  EXPECT_EQ(exp(inf), inf);
  EXPECT_EQ(log(1.0), 0);
  EXPECT_EQ(log(0.0), -inf);
  EXPECT_TRUE(std::isnan(log(-1.0)));
  EXPECT_EQ(pow(-2.0, 3.0), -8);
  EXPECT_EQ(pow(0.0, 0.0), 1);
  EXPECT_EQ(pow(10.0, 2.0), 100);
  EXPECT_EQ(atan2(0.0, 1.0), 0);
  EXPECT_EQ(atan2(0.0, -1.0), M_PI);
  EXPECT_EQ(atan2(-0.0, -1.0), -M_PI);
  EXPECT_EQ(hypot(3.0, 4.0), 5);
  EXPECT_EQ(hypot(inf, std::nan("")), inf);
  EXPECT_NEAR(sin(1e15), static_cast<double>(sinl(1e15L)), 1e-15);
}

/// FNV-1a.
std::uint64_t digest(std::uint64_t so_far, std::uint64_t word) {
  for (int byte = 0; byte < 8; ++byte) so_far = (so_far ^ (word >> (8 * byte) & 0xff)) * 1099511628211ull;
  return so_far;
}

/// A seed the compiler does not know: what it can work out itself it rounds correctly, without a call.
std::uint64_t seed(std::uint64_t value) {
  volatile std::uint64_t hidden = value;
  return hidden;
}

/// On whatever machine the test runs: with and without fused multiply-adds, of every maker.
TEST(ElementaryFunctions, HaveTheSameBitsOnEveryProcessor) {
  std::uint64_t all = 14695981039346656037ull;
  for (const Function& f : functions()) {
    core::Random random(seed(11));
    for (int i = 0; i < 20000; ++i)
      all = digest(all, std::bit_cast<std::uint64_t>(f.f(random.uniform(f.low, f.high))));
  }
  core::Random random(seed(13));
  for (int i = 0; i < 20000; ++i) {
    const auto x = static_cast<float>(random.uniform(0.001, 10));
    for (const float y : {sinf(x), cosf(x), tanf(x), atanf(x), expf(x), logf(x), atan2f(x, 2), powf(x, 1.5f)})
      all = digest(all, std::bit_cast<std::uint32_t>(y));
  }
  EXPECT_EQ(all, 8502456802025222630u);
}

/// Libraries and policies must find ours too, not the C library's.
TEST(ElementaryFunctions, AreWhatSharedLibrariesCall) {
  for (const char* name : {"sin", "cosf", "sincos", "pow", "atan2", "exp", "log", "hypot"}) {
    Dl_info place{};
    void* f = dlsym(RTLD_DEFAULT, name);
    ASSERT_NE(f, nullptr) << name;
    ASSERT_NE(dladdr(f, &place), 0) << name;
    EXPECT_EQ(std::string(place.dli_fname).find("libm"), std::string::npos)
        << name << " is of " << place.dli_fname;
  }
}

}  // namespace
}  // namespace karst::test
