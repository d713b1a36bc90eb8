// SPDX-License-Identifier: Apache-2.0
// What is answered to plain HTTP: the page, whether the server is well, and how it fares.
#pragma once

#include <string>
#include <string_view>

#include "stream/server/hub.h"

namespace lambent::stream {

/// Where clients open their WebSocket.
inline constexpr std::string_view kStreamTarget = "/stream";

struct Response {
  unsigned status = 200;
  std::string_view type = "text/plain; charset=utf-8";
  std::string body{};
  /// In place of the body: what lives as long as the server.
  std::string_view kept{};
  /// A further header that the status asks for; empty: none.
  std::string_view header{}, header_value{};
};

/// The answer to a request for a target. `authorized`: a good token came with it, or none is
/// needed. `scene` is shared as /scene.glb; null: it is not.
Response respond_to(std::string_view method, std::string_view target, bool authorized,
                    const Hub& hub, const std::string* scene);

/// The token in "Bearer TOKEN"; empty where there is none.
std::string_view bearer_token(std::string_view authorization);

}  // namespace lambent::stream
