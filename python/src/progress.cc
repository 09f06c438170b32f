#include "progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include "bind.h"
#include "unlocked.h"

namespace shapespace::python {
namespace {

using std::chrono::milliseconds;

// How long a signal waits at most; Ctrl-C is to stop a call within .2 s.
constexpr milliseconds kBetweenLooks(50);

// Thrown through the library in an abandoned thread. It is no std::exception, so that nothing on
// the way takes it for an error of its own.
struct Abandoned {};

// What the thread that works and the one that waits for it tell each other.
class Call final : public Progress {
 public:
  struct Told {
    std::string stage;
    int done, total;
    std::optional<double> share;
  };

  explicit Call(bool has_callback) : has_callback_(has_callback) {}

  // For the thread that works.
  bool Report(const std::string& stage, int done, int total) override {
    if (has_callback_) {
      std::unique_lock<std::mutex> lock(mutex_);
      told_ = Told{stage, done, total, share_};
      changed_.notify_all();
      changed_.wait(lock, [this] { return !told_ || abandoned_; });
    }
    if (abandoned_) throw Abandoned();
    return goes_on_;
  }
  void ReportShare(double share) override { share_ = share; }
  bool IsAbandoned() const { return abandoned_; }
  void End() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  // Called by the waiting thread: returns when there is a report, or the call has ended, or it is
  // time to look for signals. False if the call has ended. If the interpreter ends meanwhile, a
  // daemon thread must not run Python any more, so it waits here forever.
  bool Wait(std::optional<Told>* told) {
    const Unlocked unlocked;
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kBetweenLooks, [this] { return told_ || ended_; });
    changed_.wait(lock, [this] { return !abandoned_; });
    *told = told_;
    return !ended_;
  }
  void Answer(bool goes_on) {
    const std::lock_guard<std::mutex> lock(mutex_);
    goes_on_ = goes_on;
    told_.reset();
    changed_.notify_all();
  }
  void Abandon() {
    const std::lock_guard<std::mutex> lock(mutex_);
    abandoned_ = true;
    changed_.notify_all();
  }

 private:
  const bool has_callback_;
  std::optional<double> share_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Told> told_;  // a report without an answer
  bool goes_on_ = true, ended_ = false;
  std::atomic<bool> abandoned_ = false;
};

using Worker = std::shared_future<void>;
struct Running {
  std::shared_ptr<Call> call;
  Worker worker;
};

// Guarded by the interpreter's lock: calls that have begun, and whether the process ends, so that
// no other may begin in a daemon thread.
std::vector<Running> calls;
bool ending = false;

void ForgetThoseThatAreOver() {
  const auto over = [](const Running& running) {
    return running.worker.wait_for(milliseconds(0)) == std::future_status::ready;
  };
  calls.erase(std::remove_if(calls.begin(), calls.end(), over), calls.end());
}

std::vector<Worker> AbandonedWorkers() {
  ForgetThoseThatAreOver();
  std::vector<Worker> workers;
  for (const Running& running : calls) {
    if (running.call->IsAbandoned()) workers.push_back(running.worker);
  }
  return workers;
}

// Before a fork: the child would have the locks that they hold, but not their threads.
void WaitForAbandoned() {
  for (auto workers = AbandonedWorkers(); !workers.empty(); workers = AbandonedWorkers()) {
    const Unlocked unlocked;
    for (const Worker& worker : workers) worker.wait();
  }
}

// Before the interpreter ends, and the process destroys what the workers use.
void AbandonAll() {
  ending = true;
  for (ForgetThoseThatAreOver(); !calls.empty(); ForgetThoseThatAreOver()) {
    for (const Running& running : calls) running.call->Abandon();
    WaitForAbandoned();
  }
}

bool IsInDaemonThread() {
  return py::cast<bool>(py::module_::import("threading").attr("current_thread")().attr("daemon"));
}

}  // namespace

void RunInWorker(const py::object& callback, std::function<void(Progress*)> work) {
  if (ending && IsInDaemonThread()) {
    const Unlocked unlocked;
    WaitForever();
  }
  const auto call = std::make_shared<Call>(!callback.is_none());
  const Worker worker = std::async(
      std::launch::async, [call, work = std::move(work), earlier = AbandonedWorkers()]() mutable {
        // Two solves at a time would need the memory of two. Besides, the call may be of the same
        // Deformer, which has state.
        for (const Worker& other : earlier) other.wait();
        earlier.clear();
        if (!call->IsAbandoned()) work(call.get());
        work = nullptr;  // frees the memory even if the future is kept
        call->End();
      });
  calls.push_back({call, worker});
  try {
    std::optional<Call::Told> told;
    while (call->Wait(&told)) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!told) continue;
      const auto arguments = py::make_tuple(told->stage, told->done, told->total, told->share);
      const auto answer = py::reinterpret_steal<py::object>(EndsHereIfPythonEnds(
          [&] { return PyObject_CallObject(callback.ptr(), arguments.ptr()); }));
      if (!answer) throw py::error_already_set();
      call->Answer(!answer.is(py::bool_(false)));
    }
  } catch (...) {
    call->Abandon();
    throw;
  }
  worker.wait();  // until the thread has ended, because a fork must not copy it half way
}

void BindProgress() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&AbandonAll));
  py::module_::import("os").attr("register_at_fork")(py::arg("before") =
                                                         py::cpp_function(&WaitForAbandoned));
}

}  // namespace shapespace::python
