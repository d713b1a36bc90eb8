// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace lambent::stream {

using Clock = std::chrono::steady_clock;

/// A token bucket: allows `rate` events per second on average, and at most `burst` at once.
class RateLimit {
 public:
  RateLimit(double rate, double burst, Clock::time_point now)
      : rate_(rate), burst_(burst), left_(burst), last_(now) {}

  /// Counts an event; returns false if it exceeds the limit.
  bool pass(Clock::time_point now) {
    left_ = std::min(burst_, left_ + rate_ * std::chrono::duration<double>(now - last_).count());
    last_ = now;
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double rate_, burst_, left_;
  Clock::time_point last_;
};

}  // namespace lambent::stream
