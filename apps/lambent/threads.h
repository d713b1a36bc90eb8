// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace lambent::cli {

// More is a typing error.
inline constexpr int kMaxThreads = 1024;

/// Limits all parallel work to a number of threads while it lives; 0: no limit.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace lambent::cli
