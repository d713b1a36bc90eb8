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
                    const Hub& hub, const std::string* scene) {
  if (method != "GET" && method != "HEAD") {
    return {.status = 405,
            .body = "Only GET and HEAD are answered.\n",
            .header = "Allow",
            .header_value = "GET, HEAD"};
  }
  const std::string_view path = target.substr(0, target.find('?'));
  if (path == "/healthz") return {.body = "ok\n"};
  const bool is_scene = path == "/scene.glb" && scene != nullptr;
  if (path == "/stats" || is_scene) {
    if (!authorized) {
      return {.status = 401,
              .body = "A token is needed.\n",
              .header = "WWW-Authenticate",
              .header_value = "Bearer"};
    }
    if (is_scene) return {.type = "model/gltf-binary", .kept = *scene};
    return {.type = "application/json", .body = hub.stats_json() + "\n"};
  }
  if (path == kStreamTarget) {
    return {.status = 426,
            .body = "Here is a WebSocket.\n",
            .header = "Upgrade",
            .header_value = "websocket"};
  }
  for (const PageFile& file : page_files()) {
    if (file.path == path) return {.type = file.type, .kept = file.bytes};
  }
  return {.status = 404, .body = "There is no such page.\n"};
}

}  // namespace lambent::stream
