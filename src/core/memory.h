// SPDX-License-Identifier: Apache-2.0
// The available memory, which is checked before work that could run out of it.
#pragma once

#include <cstdint>
#include <string>

namespace lambent {

/// Memory that this process can still take [bytes]: the least of the system's available memory, of
/// what its control groups (containers, systemd) and its resource limits (ulimit -v) leave.
/// Unlimited where nothing is known. `root` is a prefix of /proc and /sys, for tests.
std::uint64_t available_memory(const std::string& root = "");

/// "3.2 GB", in powers of ten.
std::string bytes_text(std::uint64_t bytes);

}  // namespace lambent
