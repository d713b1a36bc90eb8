// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace lambent::cli {

// Maximum of --threads; larger numbers are typing errors.
inline constexpr int kMaxThreads = 1024;

/// Limits all parallel work to a number of threads while it exists; 0: no limit.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace lambent::cli
