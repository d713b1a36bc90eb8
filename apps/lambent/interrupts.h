// SPDX-License-Identifier: Apache-2.0
// Handling of Ctrl-C and similar signals.
#pragma once

namespace lambent::cli {

/// From now on, signals that end the program first remove unfinished files. The program is still
/// terminated by the signal, so that a shell sees the usual status (130 for Ctrl-C) and ends its
/// loops. A file that exceeds a limit (ulimit -f) causes an error in place of a signal.
void clean_up_on_signals();

/// While it exists, the first interrupt or request to terminate is only recorded; the second one
/// ends the program as described at clean_up_on_signals.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether there was an interrupt.
  bool interrupted() const;
  /// Ends the program as that interrupt would have done, so that a shell sees the usual status.
  /// Returns if there was none.
  void end_if_interrupted() const;
};

}  // namespace lambent::cli
