// SPDX-License-Identifier: Apache-2.0
// lambent serve: keeps the light of one shared scene up to date, and sends it to clients.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/memory.h"
#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/field_updates.h"
#include "lambent/help.h"
#include "lambent/input.h"
#include "lambent/interrupts.h"
#include "lambent/memory_check.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/progress_bar.h"
#include "lambent/quality.h"
#include "lambent/scene_options.h"
#include "lambent/serve_options.h"
#include "lambent/server_address.h"
#include "lambent/step.h"
#include "lambent/threads.h"
#include "lambent/words.h"
#include "scenes/glb_writer.h"
#include "stream/edits/edits.h"
#include "stream/server/access.h"
#include "stream/server/listener.h"
#include "stream/server/server.h"

namespace lambent::cli {
namespace {

constexpr const char* kServeExamples =
    "  lambent serve scene.glb                      then open http://localhost:8080/\n"
    "  lambent serve scene.glb --rate 20 --size 480p\n"
    "  lambent serve scene.glb --light-from light.example.org --port 8081\n"
    "  lambent serve scene.glb --host 0.0.0.0 --tokens tokens --certificate c.pem --key k.pem\n";

/// Settings of pictures, with the largest size.
FrameSettings frame_settings(const ServeOptions& options) {
  FrameSettings frame = quality_settings(quality_from_name(options.quality));
  frame.seed = options.seed;
  frame.temporal_antialiasing = true;
  if (frame.denoise && frame.samples == 1) frame.averaged_frames = kAveragedFrames;
  return frame;
}

Expected<stream::PictureSettings> picture_settings(const ServeOptions& options) {
  stream::PictureSettings settings;
  settings.frame = frame_settings(options);
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  const int least = static_cast<int>(stream::kMinPictureSide);
  if (std::min(size->x, size->y) < least ||
      std::max(size->x, size->y) > stream::kMaxEncodedLongSide ||
      std::min(size->x, size->y) > stream::kMaxEncodedShortSide) {
    return fail("--size", options.size, "pictures are streamed of 16x16 to 3840x2160 pixels");
  }
  settings.limits = options.server.world.pictures.limits;
  settings.limits.size = *size;
  constexpr double kBitsOfMegabit = 1e6;
  settings.limits.bitrate = static_cast<std::uint32_t>(options.max_megabits * kBitsOfMegabit);
  const auto stops = parse_exposure(options.exposure);
  if (!stops) return tl::unexpected(stops.error());
  settings.exposure_stops = *stops;
  settings.tone_map = *tone_map_from_name(options.tone_map);
  settings.encoder = options.encoder;
  if (const auto works = stream::check_encoder(options.encoder); !works) {
    return fail("--encoder", options.encoder, works.error().cause, works.error().kind);
  }
  return settings;
}

/// Fails where the renderers of all clients would not fit.
Expected<void> check_memory(const ServeOptions& options, std::size_t clients,
                            const glm::uvec2& size) {
  RenderOptions picture;
  picture.quality = options.quality;
  const std::uint64_t one = picture_bytes(picture, glm::ivec2(size));
  const std::uint64_t available = available_memory();
  if (one * clients <= available) return {};
  return fail(options.picture_clients < 0 ? "--clients" : "--picture-clients",
              std::to_string(clients),
              "their pictures take " + lambent::bytes_text(one) + " each, and " +
                  lambent::bytes_text(available) +
                  " are left; take fewer clients of pictures or a smaller --size",
              Error::Kind::failed);
}

Expected<void> check(const ServeOptions& options) {
  if (const auto fine = check_scene_input(options.scene.file); !fine) return fine;
  const stream::ListenSettings& listen = options.server.listen;
  if (listen.certificate.empty() != listen.key.empty()) {
    return fail(listen.key.empty() ? "--certificate" : "--key", "",
                "--certificate and --key go together");
  }
  if (listen.tokens.empty() && !stream::is_loopback(listen.host)) {
    return fail("--host", listen.host,
                "can be reached from other machines: name a file of tokens by --tokens "
                "(docs/serve.md)");
  }
  const auto fine = field_settings(options.field, {}, options.seed, -1);
  if (!fine) return tl::unexpected(fine.error());
  if (options.picture_clients > static_cast<int>(options.server.max_clients)) {
    return fail("--picture-clients", std::to_string(options.picture_clients),
                "is more than --clients " + std::to_string(options.server.max_clients));
  }
  return {};
}

/// Fails where a server could not start now, which is told before the scene is read.
Expected<void> check_start(const stream::ServerSettings& server) {
  if (!server.listen.record.empty()) {
    if (const auto can = check_place(server.listen.record); !can) return can;
  }
  if (const auto can = stream::Listener::check(server.listen); !can) return can;
  return server.publish.name.empty() ? Expected<void>()
                                     : stream::BrokerPublisher::check(server.publish);
}

/// The scene as a file for clients.
Expected<std::shared_ptr<const std::string>> shared_scene(const Scene& scene) {
  begin_step("writing the scene for clients");
  Expected<std::string> bytes = scenes::encode_glb(scene);
  if (!bytes) return tl::unexpected(bytes.error());
  tell("sharing the scene, " + lambent::bytes_text(bytes->size()));
  return std::make_shared<const std::string>(std::move(*bytes));
}

/// Serves until the program is interrupted.
template <class Served>
Expected<void> serve_world(const ServeOptions& options, const Served& served,
                           stream::ServerSettings settings) {
  if (options.share_scene) {
    auto shared = shared_scene(served.scene);
    if (!shared) return tl::unexpected(shared.error());
    settings.listen.scene = std::move(*shared);
  }
  begin_step("serving");
  if (!settings.listen.record.empty()) {
    if (const auto made = make_folders(settings.listen.record); !made) return made;
  }
  const InterruptGuard guard;
  const auto server = stream::Server::open(served, settings);
  if (!server) return tl::unexpected(server.error());
  tell("serving " + options.scene.file + " at " + (*server)->url() + " (Ctrl-C ends it)");
  const auto done = (*server)->run([&guard] { return guard.interrupted(); });
  if (!done) return done;
  const stream::HubStats stats = (*server)->stats();
  tell("served " + count_text(stats.joined, "client") + " with " +
       count_text(stats.pictures, "picture") + " in " + count_text(stats.state, "update"));
  return {};
}

/// Maximum number of clients of pictures at a time.
std::size_t picture_clients(const ServeOptions& options) {
  return options.picture_clients < 0 ? options.server.max_clients
                                     : static_cast<std::size_t>(options.picture_clients);
}

/// The server's settings from the options. `rate` is the number of updates of the light per second.
stream::ServerSettings server_settings(const ServeOptions& options,
                                       const stream::PictureSettings& pictures, float rate) {
  stream::ServerSettings settings = options.server;
  settings.max_picture_clients = picture_clients(options);
  settings.world.rate = rate;
  settings.world.pictures = pictures;
  constexpr double kMsOfSecond = 1000.0;
  // On average, no picture should delay the light by much more than an update's interval
  stream::PaceLimits& limits = settings.world.pictures.limits;
  if (rate > 0.0f) {
    limits.picture_ms = std::min(limits.picture_ms, 2.0 * kMsOfSecond / static_cast<double>(rate));
  }
  settings.listen.idle_timeout =
      std::chrono::milliseconds(static_cast<int>(options.idle_s * kMsOfSecond));
  settings.listen.log = [](const std::string& text) { warn(printable(text)); };
  return settings;
}

/// The view of the options, with a picture's aspect.
Expected<View> served_view(const ServeOptions& options, const World& world,
                           const glm::uvec2& size) {
  const glm::vec2 pixels(size);
  return choose_view(options.scene, world, pixels.x / pixels.y);
}

/// Serves the scene in the light that another server computes.
Expected<void> serve_relayed(const ServeOptions& options, const stream::PictureSettings& pictures) {
  begin_step("connecting to the light");
  const auto upstream = open_upstream(options.light_from);
  if (!upstream) return tl::unexpected(upstream.error());
  const stream::Welcome& welcome = (*upstream)->welcome();
  begin_step("reading the scene");
  Expected<OpenedScene> opened = open_lit_scene(options.scene);
  if (!opened) return tl::unexpected(opened.error());
  Scene& scene = opened->scene;
  begin_step("preparing the scene for rays");
  World world(scene);
  const auto lit = add_light_of_server("--light-from", options.light_from.server, welcome,
                                       options.scene, *opened, world);
  if (!lit) return lit;
  Camera camera = stream::camera_of(welcome.camera);
  const SceneOptions& asked = options.scene;
  if (!asked.camera.empty() || !asked.eye.empty() || !asked.target.empty() || asked.fov_degrees) {
    const Expected<View> view = served_view(options, world, pictures.limits.size);
    if (!view) return tl::unexpected(view.error());
    tell("camera: " + describe(*view));
    camera = view->camera;
  }
  tell("light: that of " + options.light_from.server +
       (welcome.role == stream::Role::change ? "" : ", which lets nobody change it from here"));
  return serve_world(options, stream::RelayedWorld{scene, world, **upstream, camera},
                     server_settings(options, pictures, welcome.rate));
}

/// Serves the scene in light that is computed locally.
Expected<void> serve_own(const ServeOptions& options, const stream::PictureSettings& pictures) {
  begin_step("reading the scene");
  Expected<OpenedScene> opened = open_lit_scene(options.scene);
  if (!opened) return tl::unexpected(opened.error());
  Scene& scene = opened->scene;
  if (options.server.world.play && scene.animations.empty()) {
    return fail("--play", "", "the scene has no animation that can be played");
  }
  begin_step("preparing the scene for rays");
  World world(scene);
  const Expected<View> view = served_view(options, world, pictures.limits.size);
  if (!view) return tl::unexpected(view.error());
  const auto light =
      add_first_light(options.scene.light, view->camera, opened->sky_dome, scene, world);
  if (!light) return tl::unexpected(light.error());
  tell("camera: " + describe(*view));
  tell("light: " + light->description);
  const auto wanted = field_settings(options.field, scene, options.seed, -1);
  if (!wanted) return tl::unexpected(wanted.error());
  begin_step("updating the field");
  Expected<IrradianceField> field = make_field(*wanted, options.field, world, view->camera, 1);
  if (!field) return tl::unexpected(field.error());
  nlohmann::ordered_json stats;
  const UpdateRequest request{0, 0.0, glm::vec3(view->camera.world_from_view[3])};
  update_field(world, options.updates, request, *field, stderr_progress(), stats);
  return serve_world(options, stream::ServedWorld{scene, world, *field, view->camera},
                     server_settings(options, pictures, options.server.world.rate));
}

/// Reads the address of the broker to which light is also published, if any.
Expected<void> read_publish(ServeOptions& options) {
  if (options.publish.empty()) return {};
  stream::ConnectSettings parsed;
  const auto fine = parse_server_address("--publish", options.publish, parsed);
  if (!fine) return fine;
  if (parsed.broker.name.empty()) {
    return fail("--publish", options.publish, "is no broker's address: nats://HOST[:PORT]/NAME");
  }
  options.server.publish = parsed.broker;
  return {};
}

Expected<void> serve(ServeOptions options) {
  if (const auto fine = check(options); !fine) return fine;
  if (const auto fine = read_publish(options); !fine) return fine;
  options.scene.keep_sky_dome = options.share_scene;
  const auto pictures = picture_settings(options);
  if (!pictures) return tl::unexpected(pictures.error());
  const glm::uvec2& size = pictures->limits.size;
  if (const auto fits = check_memory(options, picture_clients(options), size); !fits) return fits;
  if (const auto can = check_start(options.server); !can) return can;
  const ThreadLimit limit(options.threads);
  return options.light_from.server.empty() ? serve_own(options, *pictures)
                                           : serve_relayed(options, *pictures);
}

}  // namespace

void add_serve(CLI::App& app, Run& run) {
  auto o = std::make_shared<ServeOptions>();
  CLI::App* command =
      app.add_subcommand("serve", "Serve a scene to browsers and other clients, live");
  command->group(kStreamGroup);
  add_serve_options(*command, *o);
  set_examples(*command, kServeExamples);
  command->callback([o, &run] { run = [o] { return serve(*o); }; });
}

}  // namespace lambent::cli
