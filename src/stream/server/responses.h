// SPDX-License-Identifier: Apache-2.0
// Responses to plain HTTP requests: the pages, health checks, and statistics.
#pragma once

#include <string>
#include <string_view>

#include "stream/server/hub.h"

namespace lambent::stream {

/// Target at which clients open their WebSocket.
inline constexpr std::string_view kStreamTarget = "/stream";

struct Response {
  unsigned status = 200;
  std::string_view type = "text/plain; charset=utf-8";
  std::string body{};
  /// Used in place of the body, for data that lives as long as the server.
  std::string_view kept{};
  /// A further header that the status requires; empty: none.
  std::string_view header{}, header_value{};
};

/// The response to a request for a target. `authorized`: it has a valid token, or none is needed.
/// `scene` is served as /scene.glb; null: it is not.
Response respond_to(std::string_view method, std::string_view target, bool authorized,
                    const Hub& hub, const std::string* scene);

/// The token in "Bearer TOKEN"; empty where there is none.
std::string_view bearer_token(std::string_view authorization);

}  // namespace lambent::stream
