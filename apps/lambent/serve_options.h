// SPDX-License-Identifier: Apache-2.0
// The options of `lambent serve`.
#pragma once

#include <cstdint>
#include <string>

#include "lambent/field_options.h"
#include "lambent/light_from.h"
#include "lambent/scene_options.h"
#include "stream/server/server.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lambent::cli {

/// The values of these options.
struct ServeOptions {
  SceneOptions scene;
  FieldOptions field;
  LightFromOptions light_from;
  stream::ServerSettings server;
  std::string quality = "interactive";
  std::string size = "720p";
  std::string exposure = "auto", tone_map = "aces";
  std::string publish;  // a broker's address; empty: none
  std::string encoder = std::string(stream::kDefaultEncoder);
  double max_megabits = 20.0;
  double idle_s = 20.0;
  int picture_clients = -1;  // below 0: as many as clients
  int updates = 8;
  bool share_scene = false;
  std::uint32_t seed = 1;
  int threads = 0;  // 0: all
};

/// Declares the options on `command`; `options` must outlive it.
void add_serve_options(CLI::App& command, ServeOptions& options);

}  // namespace lambent::cli
