// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

namespace lambent {

/// Told now and then how far a long operation is: the stage's name and the share done, 0 to 1.
/// Called from one thread at a time. An empty function is silent.
using ProgressFn = std::function<void(std::string_view stage, double share_done)>;

}  // namespace lambent
