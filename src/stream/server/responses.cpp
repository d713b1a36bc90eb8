// SPDX-License-Identifier: Apache-2.0
#include "stream/server/responses.h"

#include "stream/page/page.h"

namespace lambent::stream {

std::string_view bearer_token(std::string_view authorization) {
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization.starts_with(kScheme)) return {};
  return authorization.substr(kScheme.size());
}

Response respond_to(std::string_view method, std::string_view target, bool authorized,
                    const Hub& hub) {
  if (method != "GET" && method != "HEAD") {
    return {405, "text/plain; charset=utf-8", "Only GET and HEAD are answered.\n", "Allow",
            "GET, HEAD"};
  }
  const std::string_view path = target.substr(0, target.find('?'));
  if (path == "/healthz") return {.body = "ok\n"};
  if (path == "/stats") {
    if (!authorized) {
      return {401, "text/plain; charset=utf-8", "A token is needed.\n", "WWW-Authenticate",
              "Bearer"};
    }
    return {.type = "application/json", .body = hub.stats_json() + "\n"};
  }
  if (path == kStreamTarget) {
    return {426, "text/plain; charset=utf-8", "Here is a WebSocket.\n", "Upgrade", "websocket"};
  }
  for (const PageFile& file : page_files()) {
    if (file.path == path) return {.type = file.type, .body = std::string(file.text)};
  }
  return {.status = 404, .body = "There is no such page.\n"};
}

}  // namespace lambent::stream
