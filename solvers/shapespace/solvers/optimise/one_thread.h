#ifndef SHAPESPACE_SOLVERS_OPTIMISE_ONE_THREAD_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_ONE_THREAD_H_

namespace shapespace::internal {

/// While it lives, CHOLMOD and the BLAS under it work on the calling thread alone, where they are
/// built with OpenMP and are OpenBLAS. Their own threads take turns of microseconds and wait for
/// each other by spinning: that gains little on an idle machine, and where anything else runs it
/// costs many times what it gains (docs/performance.md). OpenBLAS has one number of threads for the
/// whole program: it is given back when the last of several objects goes.
class OneThread {
 public:
  OneThread();
  OneThread(const OneThread&) = delete;
  ~OneThread();

 private:
  int levels_ = 0;  ///< of OpenMP's regions, to go back to
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_ONE_THREAD_H_
