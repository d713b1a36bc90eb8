// SPDX-License-Identifier: Apache-2.0
// The transit time of a connection's bytes, without the time that the programs at its ends take,
// which may wait for a processor.
#pragma once

#include <chrono>
#include <optional>

namespace lambent::stream {

/// Total time since the connection was opened during which bytes were in transit, as the system
/// counts it: from when they were given to the system until the other end has acknowledged them
/// (which may be delayed by 40 ms). Not included is time in which the other program does not read,
/// and in which this program has provided less than could be sent.
using PathTime = std::chrono::microseconds;

/// The path time of a TCP socket; none where the system does not measure it (Linux before 4.10).
std::optional<PathTime> path_time_of(int socket);

}  // namespace lambent::stream
