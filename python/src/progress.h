#ifndef SHAPESPACE_PYTHON_PROGRESS_H_
#define SHAPESPACE_PYTHON_PROGRESS_H_

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include <shapespace/base/progress.h>

namespace shapespace::python {

namespace py = pybind11;

/// Lets Python in while a long call runs without the interpreter's lock: tells a callable how far
/// it is, and looks for Ctrl-C.
class PythonProgress final : public Progress {
 public:
  /// Thrown through the library where Python has raised an exception. It is no std::exception, so
  /// that nothing on the way takes it for an error of its own.
  struct Raised {};

  /// `callback` is None, or is called as callback(stage, done, total, share).
  explicit PythonProgress(py::object callback) : callback_(std::move(callback)) {}

  /// False if the callback returned False. \throw Raised.
  bool Report(const std::string& stage, int done, int total) override;
  void ReportShare(double share) override { share_ = share; }

  /// Raises what Python has raised; with the interpreter's lock.
  [[noreturn]] void Raise();

 private:
  using Clock = std::chrono::steady_clock;

  [[noreturn]] void Keep();

  const py::object callback_;
  std::optional<py::error_already_set> raised_;
  std::optional<double> share_;
  Clock::time_point looked_ = Clock::now();
};

/// body(Progress*), without the interpreter's lock. \throw as the body, and what `callback` and
/// handlers of signals raise.
template <typename Body>
auto WithoutLock(py::object callback, Body&& body) {
  PythonProgress progress(std::move(callback));
  try {
    const py::gil_scoped_release unlocked;
    return body(&progress);
  } catch (const PythonProgress::Raised&) {
    progress.Raise();
  }
}

}  // namespace shapespace::python

#endif  // SHAPESPACE_PYTHON_PROGRESS_H_
