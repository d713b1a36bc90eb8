// SPDX-License-Identifier: Apache-2.0
#include "lambent/light_from.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>
#include <utility>

#include "lambent/console.h"
#include "lambent/light_options.h"
#include "lambent/server_address.h"
#include "lambent/words.h"
#include "stream/edits/edits.h"

namespace lambent::cli {

Expected<void> check_same_scene(const std::string& option, const std::string& server,
                                const stream::Welcome& welcome, const Scene& scene) {
  const std::size_t lights = std::min(scene.lights.size(), stream::kMaxToldLights);
  if (welcome.instances == scene.instances.size() && welcome.lights.size() == lights) return {};
  return fail(option, server,
              "serves another scene: it has " + count_text(welcome.instances, "object") + " and " +
                  count_text(welcome.lights.size(), "light") + ", this one " +
                  count_text(scene.instances.size(), "object") + " and " +
                  count_text(lights, "light"));
}

void add_light_from_options(CLI::App& command, LightFromOptions& o,
                            const std::vector<CLI::Option*>& of_own_light) {
  command.option_defaults()->group("Light of another server");
  CLI::Option* from =
      command
          .add_option("--light-from", o.server,
                      "Render in the light that this server computes, of the same scene; edits go "
                      "there: HOST[:PORT], https:// in front for TLS")
          ->type_name("HOST");
  command.add_option("--light-token", o.token_file, "File that holds the token for that server")
      ->needs(from)
      ->type_name("FILE");
  command
      .add_option("--light-authority", o.authority,
                  "Whom to trust for it besides the system's authorities, PEM")
      ->needs(from)
      ->type_name("FILE");
  for (CLI::Option* option : of_own_light) from->excludes(option);
}

Expected<std::unique_ptr<stream::Upstream>> open_upstream(const LightFromOptions& options) {
  stream::UpstreamSettings settings;
  settings.connect.authority = options.authority;
  const auto parsed = parse_server_address("--light-from", options.server, settings.connect);
  if (!parsed) return tl::unexpected(parsed.error());
  auto token = read_token(options.token_file);
  if (!token) return tl::unexpected(token.error());
  settings.token = std::move(*token);
  auto upstream = stream::Upstream::open(settings);
  // As later, when a server that was lost is looked for
  for (bool told = false; !upstream && upstream.error().kind == Error::Kind::failed;) {
    if (!std::exchange(told, true)) {
      warn("the server of the light is not there yet, and is waited for: " +
           upstream.error().message());
    }
    std::this_thread::sleep_for(settings.retry);
    upstream = stream::Upstream::open(settings);
  }
  return upstream;
}

Expected<void> add_light_of_server(const std::string& option, const std::string& server,
                                   const stream::Welcome& welcome, const SceneOptions& options,
                                   OpenedScene& opened, World& world) {
  // The server chose its first light by its own view, so choose it here by the same view
  const auto light = add_first_light(options.light, stream::camera_of(welcome.camera),
                                     opened.sky_dome, opened.scene, world);
  if (!light) return tl::unexpected(light.error());
  return check_same_scene(option, server, welcome, opened.scene);
}

}  // namespace lambent::cli
