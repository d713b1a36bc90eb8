// SPDX-License-Identifier: Apache-2.0
// How long the bytes of a connection are on their way, told apart from how long the programs at its
// ends take, which may wait for a processor.
#pragma once

#include <chrono>
#include <optional>

namespace lambent::stream {

/// So long altogether have bytes been on their way since the connection was opened, as the system
/// counts it: from when it was given them until the other end's system had told that all were there
/// (which may take it 40 ms). Left out is the time in which the other program does not read what is
/// there, and in which ours has given less than there is room for.
using PathTime = std::chrono::microseconds;

/// The path time of a TCP socket; none where the system does not count it (Linux before 4.10).
std::optional<PathTime> path_time_of(int socket);

}  // namespace lambent::stream
