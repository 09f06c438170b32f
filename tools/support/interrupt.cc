#include "support/interrupt.h"

#include <semaphore.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <thread>

#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/system.h>

namespace shapespace::tools {
namespace {

struct State {
  std::mutex mutex;
  int signal = 0;  // pending
  std::function<void()> before_the_end;
  std::function<void()> notice;  // empty: the first signal ends the process
};

State& TheState() {
  static State* const state = new State;  // the thread may outlive main()
  return *state;
}

// A signal handler may do no more than store the signal.
std::atomic<int> received{0};
static_assert(std::atomic<int>::is_always_lock_free);
sem_t came;

void Receive(int signal) {
  received = signal;
  sem_post(&came);
}

[[noreturn]] void EndBy(int signal) {
  TheState().before_the_end();
  internal::AbandonUnfinishedFiles();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::_Exit(128 + signal);
}

// Runs on a separate thread, which may take locks and therefore remove temporaries.
void Listen() {
  State& state = TheState();
  for (;;) {
    while (sem_wait(&came) != 0) continue;
    std::function<void()> notice;
    {
      const std::lock_guard<std::mutex> lock(state.mutex);
      if (state.signal == 0) notice = state.notice;
      if (notice) state.signal = received;
    }
    if (!notice) EndBy(received);
    notice();
  }
}

}  // namespace

void HandleInterrupts(const std::function<void()>& before_the_end) {
  TheState().before_the_end = before_the_end;
  sem_init(&came, 0, 0);
  std::thread(Listen).detach();
  internal::HandleEndingSignals(Receive);
}

FirstInterruptWaits::FirstInterruptWaits(const std::function<void()>& notice) {
  const std::lock_guard<std::mutex> lock(TheState().mutex);
  TheState().notice = notice;
}

FirstInterruptWaits::~FirstInterruptWaits() {
  const std::lock_guard<std::mutex> lock(TheState().mutex);
  TheState().notice = nullptr;
}

bool Interrupted() {
  const std::lock_guard<std::mutex> lock(TheState().mutex);
  return TheState().signal != 0;
}

void EndIfInterrupted() {
  if (Interrupted()) EndBy(received);
}

}  // namespace shapespace::tools
