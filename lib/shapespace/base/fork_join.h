#ifndef SHAPESPACE_BASE_FORK_JOIN_H_
#define SHAPESPACE_BASE_FORK_JOIN_H_

// Private. The thread sanitizer cannot see how TBB and Embree, which are not built with it, hand
// work to their threads, and would report all that this work reads and writes.

#ifdef SHAPESPACE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace shapespace::internal {

/// Tells the thread sanitizer that work on other threads comes after this object's construction and
/// before its destruction. Nothing orders pieces of the work among themselves: races between them
/// are found. Without the sanitizer this does nothing.
class ForkJoin {
 public:
#ifdef SHAPESPACE_THREAD_SANITIZER
  ForkJoin() { __tsan_release(&fork_); }
  ~ForkJoin() { __tsan_acquire(&join_); }
#endif

  /// Lives as long as one piece of the work.
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

#endif  // SHAPESPACE_BASE_FORK_JOIN_H_
