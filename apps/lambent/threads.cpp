// SPDX-License-Identifier: Apache-2.0
#include "lambent/threads.h"

#include <tbb/global_control.h>

namespace lambent::cli {

struct ThreadLimit::Control {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads <= 0) return;
  control_.reset(new Control{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                                 static_cast<std::size_t>(threads))});
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace lambent::cli
