#ifndef SHAPESPACE_MINIMISE_DETAIL_CHUNKS_H_
#define SHAPESPACE_MINIMISE_DETAIL_CHUNKS_H_

#include <algorithm>
#include <vector>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {

// Vector operations in chunks: several vectors are read while a chunk of each is in the L1 cache,
// on all threads, with sums that do not depend on the number of threads.

/// Numbers per chunk: three chunks fit into the L1 cache.
inline constexpr size_t kChunkSize = 2048;

/// Calls body(begin, count, sums) for every chunk of [0, size), where `sums` are `num_sums`
/// accumulators of the chunk, initially zero. \return the sums over all chunks, added in their
/// order.
template <typename Body>
std::vector<double> ForChunks(size_t size, int num_sums, const Body& body) {
  const int chunks = static_cast<int>((size + kChunkSize - 1) / kChunkSize);
  std::vector<double> partial(static_cast<size_t>(chunks) * num_sums, 0.0);
  ParallelFor(chunks, [&](int chunk) {
    const size_t begin = chunk * kChunkSize;
    body(begin, std::min(kChunkSize, size - begin),
         partial.data() + static_cast<size_t>(chunk) * num_sums);
  });
  std::vector<double> sums(num_sums, 0.0);
  for (int chunk = 0; chunk < chunks; ++chunk) {
    for (int i = 0; i < num_sums; ++i)
      sums[i] += partial[static_cast<size_t>(chunk) * num_sums + i];
  }
  return sums;
}

/// a . b
double Dot(const double* a, const double* b, size_t count);
double Dot(const float* a, const double* b, size_t count);
/// to += factor * from
void Add(double factor, const float* from, double* to, size_t count);
/// result = a + factor * b, where `result` may be one of the two
void Combine(const double* a, double factor, const double* b, double* result, size_t count);
void Combine(const double* a, double factor, const double* b, float* result, size_t count);
void Combine(const double* a, double factor, const float* b, double* result, size_t count);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_DETAIL_CHUNKS_H_
