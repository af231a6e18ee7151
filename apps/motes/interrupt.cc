// A thread waits for the signals, so that what it does may be more than a signal handler's.
#include "motes/interrupt.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "core/temporary_files.h"

namespace motes {
namespace {

sigset_t interruptions() {
  sigset_t signals;
  sigemptyset(&signals);
  // What the shell has told the program to ignore (nohup, jobs in the background) stays ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  return signals;
}

/// What is done instead of leaving, if anything.
std::mutex stop_mutex;
std::function<void()> stop_instead;

/// Whether there was something to be done instead.
bool stop() {
  const std::lock_guard lock(stop_mutex);
  const std::function<void()> stop = std::exchange(stop_instead, nullptr);
  if (stop) stop();
  return stop != nullptr;
}

[[noreturn]] void leave(int signal) {
  TemporaryFiles::of_program().abandon();
  // Over the progress bar, if there is one.
  std::fputs(isatty(STDERR_FILENO) == 1 ? "\r\x1b[Kmotes: interrupted\n" : "motes: interrupted\n",
             stderr);
  std::fflush(stderr);
  std::signal(signal, SIG_DFL);
  sigset_t unblocked;
  sigemptyset(&unblocked);
  sigaddset(&unblocked, signal);
  pthread_sigmask(SIG_UNBLOCK, &unblocked, nullptr);
  std::raise(signal);
  _exit(128 + signal);
}

}  // namespace

void leave_when_interrupted() {
  const sigset_t signals = interruptions();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // in this thread and those that it will start
  std::thread([signals] {
    int signal = 0;
    do {
      while (sigwait(&signals, &signal) != 0) {
      }
    } while (stop());
    leave(signal);
  }).detach();
}

StopWhenInterrupted::StopWhenInterrupted(std::function<void()> stop) {
  const std::lock_guard lock(stop_mutex);
  stop_instead = std::move(stop);
}

StopWhenInterrupted::~StopWhenInterrupted() {
  const std::lock_guard lock(stop_mutex);
  stop_instead = nullptr;
}

}  // namespace motes
