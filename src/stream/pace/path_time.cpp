// SPDX-License-Identifier: Apache-2.0
#include "stream/pace/path_time.h"

// Not <netinet/tcp.h>, whose tcp_info lacks the later members.
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
  // tcpi_busy_time includes the other two
  const std::uint64_t limited = info.tcpi_rwnd_limited + info.tcpi_sndbuf_limited;
  return PathTime(info.tcpi_busy_time - std::min<std::uint64_t>(limited, info.tcpi_busy_time));
}

}  // namespace lambent::stream
