// SPDX-License-Identifier: Apache-2.0
// How much memory there is, asked before work is begun that could not be finished.
#pragma once

#include <cstdint>
#include <string>

namespace lambent {

/// Memory that this process can still take [bytes]: the least of what the system calls available,
/// what its control groups leave it (containers, systemd), and its resource limits (ulimit -v).
/// Where nothing is known, all that there could be. `root` stands before /proc and /sys, for tests.
std::uint64_t available_memory(const std::string& root = "");

/// "3.2 GB", in powers of ten.
std::string bytes_text(std::uint64_t bytes);

}  // namespace lambent
