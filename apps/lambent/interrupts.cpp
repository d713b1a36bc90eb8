// SPDX-License-Identifier: Apache-2.0
#include "lambent/interrupts.h"

#include <signal.h>

#include <atomic>

#include "core/files/atomic_file.h"

namespace lambent::cli {
namespace {

/// Ctrl-C, kill, and a terminal that was closed.
constexpr int kEndingSignals[] = {SIGINT, SIGTERM, SIGHUP};
/// Signals that a guard records. Not SIGHUP: without a terminal nobody waits for the frame.
constexpr int kGuardedSignals[] = {SIGINT, SIGTERM};

std::atomic<bool> guarding = false;
std::atomic<int> noted = 0;  // the signal; 0: none
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler uses them");

void end_by(int number) {
  discard_unfinished_files();
  // Raise the signal again with its default action
  signal(number, SIG_DFL);
  sigset_t own;
  sigemptyset(&own);
  sigaddset(&own, number);
  pthread_sigmask(SIG_UNBLOCK, &own, nullptr);
  raise(number);
}

void handle(int number) {
  for (const int guarded : kGuardedSignals) {
    if (number == guarded && guarding && noted.exchange(number) == 0) return;
  }
  end_by(number);
}

}  // namespace

void clean_up_on_signals() {
  struct sigaction action {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  for (const int number : kEndingSignals) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    // Programs started with nohup continue to ignore it
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
  signal(SIGXFSZ, SIG_IGN);
}

InterruptGuard::InterruptGuard() {
  noted = 0;
  guarding = true;
}

InterruptGuard::~InterruptGuard() {
  guarding = false;
}

bool InterruptGuard::interrupted() const {
  return noted != 0;
}

void InterruptGuard::end_if_interrupted() const {
  if (const int number = noted; number != 0) end_by(number);
}

}  // namespace lambent::cli
