#ifndef SHAPESPACE_EXPLORATION_DETAIL_DIGEST_H_
#define SHAPESPACE_EXPLORATION_DETAIL_DIGEST_H_

#include <cstddef>
#include <cstdint>
#include <string>

#define XXH_INLINE_ALL
// In browsers xxHash 0.8.3 would take instructions from arm_neon.h, which in Debian 13's emscripten
// includes headers that are not there.
#define XXH_HAS_INCLUDE(header) 0
#include <xxhash.h>

#include <shapespace/geodesic/geodesic.h>

// Digests of what a result depends on.

namespace shapespace::internal {

/// A 128-bit hash of everything that is added.
class Hasher {
 public:
  Hasher() { XXH3_128bits_reset(&state_); }
  template <typename Number>
  void Add(const Number* data, size_t count) {
    const uint64_t size = count * sizeof(Number);
    XXH3_128bits_update(&state_, &size, sizeof size);
    XXH3_128bits_update(&state_, data, size);
  }
  void Add(double number) { Add(&number, 1); }
  template <typename Matrix>
  void AddAll(const Matrix& matrix) {
    Add(matrix.data(), matrix.size());
  }
  std::string Digest() const;

 private:
  XXH3_state_t state_;
};

/// Adds the value of every option that can change a geodesic, with its name. They are taken from
/// the list of fields, so that an option that is new is not forgotten; those that change no result
/// are excepted by name.
void AddOptions(const GeodesicOptions& options, Hasher* hasher);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_DETAIL_DIGEST_H_
