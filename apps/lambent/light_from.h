// SPDX-License-Identifier: Apache-2.0
// lambent serve --light-from: pictures in the light that another server computes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene.h"
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

/// Connects to the server that the options name.
Expected<std::unique_ptr<stream::Upstream>> open_upstream(const LightFromOptions& options);

/// Fails, naming the server as the value of an option, where the objects and lights of the scene
/// differ from the server's.
Expected<void> check_same_scene(const std::string& option, const std::string& server,
                                const stream::Welcome& welcome, const Scene& scene);

}  // namespace lambent::cli
