// SPDX-License-Identifier: Apache-2.0
#include "stream/pace/path_time.h"

// In place of <netinet/tcp.h>, whose tcp_info ends earlier.
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstddef>

namespace lambent::stream {

std::optional<PathTime> path_time_of(int socket) {
  tcp_info info{};
  socklen_t size = sizeof(info);
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return std::nullopt;
  constexpr std::size_t kEnd =
      offsetof(tcp_info, tcpi_sndbuf_limited) + sizeof(info.tcpi_sndbuf_limited);
  if (size < kEnd) return std::nullopt;
  // The first counts the others, too
  const std::uint64_t limited = info.tcpi_rwnd_limited + info.tcpi_sndbuf_limited;
  return PathTime(info.tcpi_busy_time - std::min<std::uint64_t>(limited, info.tcpi_busy_time));
}

}  // namespace lambent::stream
