#ifndef SHAPESPACE_BASE_INTERNAL_FORK_JOIN_H_
#define SHAPESPACE_BASE_INTERNAL_FORK_JOIN_H_

// Private. TBB and Embree are not built with the thread sanitizer, which therefore does not see how
// they pass work to their threads, and would report false races.

#ifdef SHAPESPACE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace shapespace::internal {

/// Tells the thread sanitizer that work on other threads happens after this object's construction
/// and before its destruction. Parts of the work are not ordered with respect to each other, so
/// races between them are still found. Does nothing without the sanitizer.
class ForkJoin {
 public:
#ifdef SHAPESPACE_THREAD_SANITIZER
  ForkJoin() { __tsan_release(&fork_); }
  ~ForkJoin() { __tsan_acquire(&join_); }
#endif

  /// Exists during one part of the work.
  class Piece {
   public:
#ifdef SHAPESPACE_THREAD_SANITIZER
    explicit Piece(const ForkJoin& all) : all_(all) { __tsan_acquire(&all_.fork_); }
    ~Piece() { __tsan_release(&all_.join_); }

   private:
    const ForkJoin& all_;
#else
    explicit Piece(const ForkJoin&) {}
#endif
  };

#ifdef SHAPESPACE_THREAD_SANITIZER
 private:
  mutable char fork_ = 0, join_ = 0;
#endif
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_FORK_JOIN_H_
