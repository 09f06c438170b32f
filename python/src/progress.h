#ifndef SHAPESPACE_PYTHON_PROGRESS_H_
#define SHAPESPACE_PYTHON_PROGRESS_H_

#include <functional>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>

#include <pybind11/pybind11.h>

#include <shapespace/base/progress.h>

namespace shapespace::python {

namespace py = pybind11;

/// Calls work(Progress*) in a thread of its own, and returns when it is over. The calling thread
/// waits without the interpreter's lock. It runs handlers of signals, and, where `callback` is not
/// None, callback(stage, done, total, share) for every report; the work is told to stop where that
/// returns False. `work` throws nothing.
///
/// \throw py::error_already_set at once, with what the callback or a handler raises. The work is
///        then abandoned: it goes on until its next report, or its end. So `work` must own
///        everything that it uses, and nothing of Python's. Calls that begin later start when it is
///        over; forks and the end of the interpreter wait for it too.
void RunInWorker(const py::object& callback, std::function<void(Progress*)> work);

/// What body(Progress*) returns, which runs as above. Its captures are copies: Python may change or
/// delete the arguments of a call that was abandoned. \throw also as the body.
template <typename Body>
auto WithoutLock(const py::object& callback, Body body) {
  using Result = std::invoke_result_t<Body&, Progress*>;
  const auto task = std::make_shared<std::packaged_task<Result(Progress*)>>(std::move(body));
  std::future<Result> result = task->get_future();
  RunInWorker(callback, [task](Progress* progress) { (*task)(progress); });
  return result.get();
}

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_PROGRESS_H_
