#include "support/mpi_crew.h"

#include <cstdlib>
#include <string>

#include "support/error_message.h"
#include "support/tool.h"

#ifdef SHAPESPACE_HAS_MPI
#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#endif

namespace shapespace::tools {
namespace {

// Whether a launcher has started this process as one of several. (MPI_Init would detect it too, but
// is slow, and starts daemons if there is no launcher.)
bool IsLaunched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

#ifdef SHAPESPACE_HAS_MPI

constexpr int kRequest = 1, kTask = 2;

class MpiCrew final : public ProcessPool {
 public:
  MpiCrew() {
    int provided;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    if (provided < MPI_THREAD_SERIALIZED) {
      throw std::runtime_error("this MPI does not allow a second thread");
    }
  }
  ~MpiCrew() override { MPI_Finalize(); }

  int Rank() const override { return rank_; }
  int Size() const override { return size_; }

  std::vector<std::string> ForEach(int count, int at_once,
                                   const std::function<std::string(int)>& body) override {
    std::vector<std::string> results(count);
    std::vector<int> owner(count, -1);
    // Each of this process's threads runs one task after the other, until there is none left.
    const auto run_all = [&](const std::function<int()>& next) {
      const int threads = std::min(at_once, NumThreads());
      std::atomic<bool> failed = false;
      ParallelTasks(threads, threads, [&](int) {
        try {
          for (int i; !failed && (i = next()) < count;) {
            results[i] = body(i);
            owner[i] = rank_;
          }
        } catch (...) {
          failed = true;
          throw;
        }
      });
    };
    if (rank_ == 0) {
      HandOut(count, run_all);
    } else {
      std::mutex asking;  // one thread at a time may call MPI
      int task = 0;
      run_all([&] {
        const std::lock_guard<std::mutex> lock(asking);
        if (task < count) task = Ask();  // each rank is told once that there is none left
        return task;
      });
    }
    MPI_Allreduce(MPI_IN_PLACE, owner.data(), count, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    for (int i = 0; i < count; ++i) Broadcast(owner[i], &results[i]);
    return results;
  }

  std::string FromFirst(const std::string& bytes) override {
    std::string result = bytes;
    Broadcast(0, &result);
    return result;
  }

 private:
  // The first rank works too: a separate thread, which is mostly idle, replies to the other ranks.
  // Its other threads do not call MPI in the meantime.
  void HandOut(int count, const std::function<void(const std::function<int()>&)>& run_all) {
    std::atomic<int> next = 0;
    std::atomic<bool> failed = false;
    std::thread answering([&] {
      for (int finished = 0; finished < size_ - 1 && !failed;) {
        int waiting;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, kRequest, MPI_COMM_WORLD, &waiting, &status);
        if (!waiting) {
          std::this_thread::sleep_for(std::chrono::microseconds(500));
          continue;
        }
        MPI_Recv(nullptr, 0, MPI_INT, status.MPI_SOURCE, kRequest, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        const int task = next++;
        if (task >= count) ++finished;
        MPI_Send(&task, 1, MPI_INT, status.MPI_SOURCE, kTask, MPI_COMM_WORLD);
      }
    });
    try {
      run_all([&]() -> int { return next++; });
    } catch (...) {
      failed = true;
      answering.join();
      throw;
    }
    answering.join();
  }

  static int Ask() {
    int task;
    MPI_Send(nullptr, 0, MPI_INT, 0, kRequest, MPI_COMM_WORLD);
    MPI_Recv(&task, 1, MPI_INT, 0, kTask, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return task;
  }

  static void Broadcast(int owner, std::string* bytes) {
    constexpr size_t kPart = 1 << 30;         // MPI counts in int
    unsigned long long size = bytes->size();  // NOLINT(google-runtime-int)
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, owner, MPI_COMM_WORLD);
    bytes->resize(size);
    for (size_t at = 0; at < size; at += kPart) {
      MPI_Bcast(&(*bytes)[at], static_cast<int>(std::min<size_t>(kPart, size - at)), MPI_BYTE,
                owner, MPI_COMM_WORLD);
    }
  }

  int rank_ = 0, size_ = 1;
};

// Redirects stdout and stderr to /dev/null.
class Silence {
 public:
  Silence() : stderr_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~Silence() {
    dup2(stderr_, STDERR_FILENO);
    close(stderr_);
  }

 private:
  const int stderr_;
};

void Abort(const MpiCrew& crew, const std::string& message) {
  Complain((crew.Rank() > 0 ? "rank " + std::to_string(crew.Rank()) + ": " : "") + message);
  MPI_Abort(MPI_COMM_WORLD, 1);
}

void WithRanks(const std::function<void(ProcessPool*)>& body) {
  MpiCrew crew;
  try {
    std::optional<Silence> silence;
    if (crew.Rank() > 0) silence.emplace();
    body(&crew);
  } catch (const UsageError&) {
    if (crew.Rank() == 0) throw;
  } catch (const Error& error) {
    Abort(crew, MessageOf(error));
  } catch (const std::exception& error) {
    Abort(crew, error.what());
  }
}

#endif  // SHAPESPACE_HAS_MPI

}  // namespace

void WithCrew(const std::function<void(ProcessPool*)>& body) {
  if (IsLaunched()) {
#ifdef SHAPESPACE_HAS_MPI
    WithRanks(body);
    return;
#else
    throw UsageError(
        "this program was built without MPI, so its processes cannot share work; start it without "
        "mpirun, or build it where CMake finds MPI");
#endif
  }
  ProcessPool alone;
  body(&alone);
}

}  // namespace shapespace::tools
