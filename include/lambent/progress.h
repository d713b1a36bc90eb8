// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

namespace lambent {

/// Called now and then during a long operation with the stage's name and the share done, 0 to 1;
/// from one thread at a time. An empty function is not called.
using ProgressFn = std::function<void(std::string_view stage, double share_done)>;

}  // namespace lambent
