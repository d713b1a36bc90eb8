// SPDX-License-Identifier: Apache-2.0
#include "lambent/step.h"

#include <atomic>

namespace lambent::cli {
namespace {

std::atomic<const char*> step = "reading the command line";

}  // namespace

void begin_step(const char* doing) {
  step = doing;
}

const char* current_step() {
  return step;
}

}  // namespace lambent::cli
