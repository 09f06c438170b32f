#ifndef SHAPESPACE_PYTHON_UNLOCKED_H_
#define SHAPESPACE_PYTHON_UNLOCKED_H_

#include <cxxabi.h>

#include <chrono>
#include <thread>

#include <pybind11/pybind11.h>

namespace shapespace::python {

namespace py = pybind11;

/// The calling thread never goes on. The process may end meanwhile.
[[noreturn]] inline void WaitForever() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// What body() returns, which has nothing to destroy. When the interpreter ends, Python before 3.14
/// ends a daemon thread that wants its lock by unwinding the stack. Destructors on the way, which
/// use the interpreter or must not throw, would then end the process; so such a thread waits here
/// forever.
template <typename Body>
auto EndsHereIfPythonEnds(const Body& body) {
#ifdef __GLIBCXX__
  try {
    return body();
  } catch (abi::__forced_unwind&) {
    WaitForever();
  }
#else
  return body();
#endif
}

/// Within its scope the thread does not hold the interpreter's lock; as py::gil_scoped_release, but
/// safe in daemon threads.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked() {
    EndsHereIfPythonEnds([this] { PyEval_RestoreThread(state_); });
  }

 private:
  PyThreadState* const state_;
};

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_UNLOCKED_H_
