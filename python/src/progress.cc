#include "progress.h"

#include <pybind11/stl.h>

namespace shapespace::python {
namespace {

// Taking the interpreter's lock more often than that would cost more than anybody notices.
constexpr std::chrono::milliseconds kBetweenLooks(50);

}  // namespace

void PythonProgress::Keep() {
  raised_.emplace();
  throw Raised();
}

void PythonProgress::Raise() {
  const py::error_already_set raised = *std::move(raised_);
  raised_.reset();
  throw py::error_already_set(raised);
}

bool PythonProgress::Report(const std::string& stage, int done, int total) {
  const bool looks = Clock::now() - looked_ > kBetweenLooks;
  if (callback_.is_none() && !looks) return true;
  const py::gil_scoped_acquire locked;
  if (looks) {
    looked_ = Clock::now();
    if (PyErr_CheckSignals() != 0) Keep();
  }
  if (callback_.is_none()) return true;
  try {
    return !callback_(stage, done, total, share_).is(py::bool_(false));
  } catch (py::error_already_set& raised) {
    raised_.emplace(std::move(raised));
    throw Raised();
  }
}

}  // namespace shapespace::python
