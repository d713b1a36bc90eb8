// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace lambent {

/// Wall-clock time.
class Stopwatch {
 public:
  /// Milliseconds since construction or the last lap.
  double ms() const { return ms_until(Clock::now()); }
  /// ms(), and starts a lap.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double ms = ms_until(now);
    start_ = now;
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  double ms_until(Clock::time_point now) const {
    return std::chrono::duration<double, std::milli>(now - start_).count();
  }

  Clock::time_point start_ = Clock::now();
};

}  // namespace lambent
