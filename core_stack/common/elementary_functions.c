// sin, exp, pow and their kin for the whole process, the same bits on every processor.
//
// The C library picks another build of these functions where the processor has fused multiply-adds, and its
// results then differ in their last bits. SLEEF's scalar functions (Shibata and Petrogalli, 2020; within 1
// ulp) are plain C and the same everywhere. Every program of karst links this file and exports the names, so
// that shared libraries and policies call them too. What IEEE 754 rounds correctly (sqrt, fma, floor, fmod)
// needs none.
#include <sleef.h>

#define ONE_ARGUMENT(name, ulp)                              \
  double name(double x);                                     \
  double name(double x) { return Sleef_##name##_u##ulp(x); } \
  float name##f(float x);                                    \
  float name##f(float x) { return Sleef_##name##f_u##ulp(x); }

#define TWO_ARGUMENTS(name, ulp)                                          \
  double name(double x, double y);                                        \
  double name(double x, double y) { return Sleef_##name##_u##ulp(x, y); } \
  float name##f(float x, float y);                                        \
  float name##f(float x, float y) { return Sleef_##name##f_u##ulp(x, y); }

ONE_ARGUMENT(sin, 10)
ONE_ARGUMENT(cos, 10)
ONE_ARGUMENT(tan, 10)
ONE_ARGUMENT(asin, 10)
ONE_ARGUMENT(acos, 10)
ONE_ARGUMENT(atan, 10)
ONE_ARGUMENT(sinh, 10)
ONE_ARGUMENT(cosh, 10)
ONE_ARGUMENT(tanh, 10)
ONE_ARGUMENT(asinh, 10)
ONE_ARGUMENT(acosh, 10)
ONE_ARGUMENT(atanh, 10)
ONE_ARGUMENT(exp, 10)
ONE_ARGUMENT(exp2, 10)
ONE_ARGUMENT(exp10, 10)
ONE_ARGUMENT(expm1, 10)
ONE_ARGUMENT(log, 10)
ONE_ARGUMENT(log2, 10)
ONE_ARGUMENT(log10, 10)
ONE_ARGUMENT(log1p, 10)
ONE_ARGUMENT(cbrt, 10)
ONE_ARGUMENT(erf, 10)
ONE_ARGUMENT(erfc, 15)
ONE_ARGUMENT(tgamma, 10)
ONE_ARGUMENT(lgamma, 10)
TWO_ARGUMENTS(atan2, 10)
TWO_ARGUMENTS(pow, 10)
TWO_ARGUMENTS(hypot, 05)

void sincos(double x, double* sine, double* cosine);
void sincos(double x, double* sine, double* cosine) {
  *sine = Sleef_sin_u10(x);
  *cosine = Sleef_cos_u10(x);
}
void sincosf(float x, float* sine, float* cosine);
void sincosf(float x, float* sine, float* cosine) {
  *sine = Sleef_sinf_u10(x);
  *cosine = Sleef_cosf_u10(x);
}
