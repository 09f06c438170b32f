#include <shapespace/minimise/detail/chunks.h>

#include <shapespace/base/internal/clones.h>

namespace shapespace::internal {
namespace {

template <typename A>
SHAPESPACE_INLINE double DotOf(const A* a, const double* b, size_t count) {
  // Four registers of eight sums each, so that vectorisation needs no reordering of sums.
  constexpr size_t kLanes = 32;
  double sums[kLanes] = {};
  size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (size_t k = 0; k < kLanes; ++k) sums[k] += a[i + k] * b[i + k];
  }
  for (; i < count; ++i) sums[i % kLanes] += a[i] * b[i];
  double sum = 0;
  for (double s : sums) sum += s;
  return sum;
}

template <typename B, typename Result>
SHAPESPACE_INLINE void CombineTo(const double* a, double factor, const B* b, Result* result,
                                 size_t count) {
  SHAPESPACE_INDEPENDENT
  for (size_t i = 0; i < count; ++i) result[i] = static_cast<Result>(a[i] + factor * b[i]);
}

}  // namespace

// Function multiversioning does not work for templates.

SHAPESPACE_CLONES
double Dot(const double* a, const double* b, size_t count) { return DotOf(a, b, count); }

SHAPESPACE_CLONES
double Dot(const float* a, const double* b, size_t count) { return DotOf(a, b, count); }

SHAPESPACE_CLONES
void Add(double factor, const float* from, double* to, size_t count) {
  CombineTo(to, factor, from, to, count);
}

SHAPESPACE_CLONES
void Combine(const double* a, double factor, const double* b, double* result, size_t count) {
  CombineTo(a, factor, b, result, count);
}

SHAPESPACE_CLONES
void Combine(const double* a, double factor, const double* b, float* result, size_t count) {
  CombineTo(a, factor, b, result, count);
}

SHAPESPACE_CLONES
void Combine(const double* a, double factor, const float* b, double* result, size_t count) {
  CombineTo(a, factor, b, result, count);
}

}  // namespace shapespace::internal
