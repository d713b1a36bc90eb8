// SPDX-License-Identifier: Apache-2.0
// What the program does on Ctrl-C and its kin.
#pragma once

namespace lambent::cli {

/// From now on, signals that end the program first remove files that are half written. The program
/// still dies of the signal, so that a shell sees the customary status (130 for Ctrl-C) and ends
/// its loops. A file that grows past a limit (ulimit -f) is an error in place of a signal.
void clean_up_on_signals();

/// While it lives, the first interrupt or request to terminate is noted only; the second one ends
/// the program as clean_up_on_signals has it.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether there was one.
  bool interrupted() const;
};

}  // namespace lambent::cli
