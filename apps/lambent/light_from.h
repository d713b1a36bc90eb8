// SPDX-License-Identifier: Apache-2.0
// lambent serve --light-from: pictures in the light that another server computes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene_options.h"
#include "lambent/world.h"
#include "stream/client/upstream.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

struct LightFromOptions {
  std::string server;  // empty: the light is computed locally
  std::string token_file, authority;
};

/// Declares the options on `command`; `options` must outlive it. Options of local light are refused
/// beside --light-from.
void add_light_from_options(CLI::App& command, LightFromOptions& options,
                            const std::vector<CLI::Option*>& of_own_light);

/// Connects to the server that the options name. Waits for one that does not answer yet or has too
/// many clients, and warns of that.
Expected<std::unique_ptr<stream::Upstream>> open_upstream(const LightFromOptions& options);

/// Fails, naming the server as the value of an option, where the objects and lights of a scene
/// differ from the server's.
Expected<void> check_same_scene(const std::string& option, const std::string& server,
                                const stream::Welcome& welcome, const Scene& scene);

/// Gives a copy of a server's scene the light that the server chose for it, and updates the world.
/// Fails as check_same_scene does.
Expected<void> add_light_of_server(const std::string& option, const std::string& server,
                                   const stream::Welcome& welcome, const SceneOptions& options,
                                   OpenedScene& opened, World& world);

}  // namespace lambent::cli
