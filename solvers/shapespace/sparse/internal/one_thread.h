#ifndef SHAPESPACE_SPARSE_INTERNAL_ONE_THREAD_H_
#define SHAPESPACE_SPARSE_INTERNAL_ONE_THREAD_H_

namespace shapespace::internal {

/// While an object of this class exists, BLAS and the CHOLMOD of Ceres use the calling thread only,
/// if they are built with OpenMP and OpenBLAS. Their own threads synchronise every few microseconds
/// by busy-waiting: that gains little on an idle machine and is many times slower on a busy one
/// (docs/performance.md). OpenBLAS has one number of threads for the whole program; it is restored
/// when the last of several objects is destroyed.
class OneThread {
 public:
  OneThread();
  OneThread(const OneThread&) = delete;
  ~OneThread();

 private:
  [[maybe_unused]] int levels_ = 0;  ///< the previous limit of OpenMP's nested regions
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_INTERNAL_ONE_THREAD_H_
