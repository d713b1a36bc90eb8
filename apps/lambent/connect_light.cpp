// SPDX-License-Identifier: Apache-2.0
// Pictures of a local scene, in the light that a server sends.
#include <chrono>
#include <string>
#include <vector>

#include "compose/unlit.h"
#include "core/image/exposure.h"
#include "core/image/tone_map.h"
#include "lambent/connect.h"
#include "lambent/console.h"
#include "lambent/interrupts.h"
#include "lambent/light_from.h"
#include "lambent/parse.h"
#include "lambent/quality.h"
#include "lambent/render_output.h"
#include "lambent/renderer.h"
#include "lambent/step.h"
#include "lambent/words.h"
#include "stream/client/lit_scene.h"
#include "stream/textures/h265.h"

namespace lambent::cli {
namespace {

/// Receives and answers messages until the light changes.
Expected<void> wait_for_light(stream::Client& client, stream::LitScene& lit,
                              std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) break;
    const auto message = client.receive(left);
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    const auto followed = lit.follow(**message);
    if (!followed) return tl::unexpected(followed.error());
    if (followed->answer) {
      if (const auto sent = client.send(*followed->answer); !sent) return sent;
    }
    if (followed->lit) return {};
  }
  return fail("", "", "no light came in time", Error::Kind::failed);
}

/// The options of `lambent render` that give such pictures.
RenderOptions render_options(const ConnectOptions& options) {
  RenderOptions render;
  render.quality = options.quality;
  render.frames = options.frames > 1 ? options.frames : 0;
  render.exposure = options.exposure;
  render.tone_map = options.tone_map;
  render.layers = options.layers;
  return render;
}

}  // namespace

Expected<void> render_by_stream(const ConnectOptions& options,
                                const stream::ConnectSettings& settings, stream::Joined& joined,
                                const std::optional<stream::CameraInput>& camera) {
  begin_step("reading the scene");
  Expected<OpenedScene> opened = open_lit_scene(options.scene);
  if (!opened) return tl::unexpected(opened.error());
  Scene& scene = opened->scene;
  begin_step("preparing the scene for rays");
  World world(scene);
  // The server chose its first light by its own view, so choose it here by the same view
  const auto light = add_first_light(options.scene.light, stream::camera_of(joined.welcome.camera),
                                     opened->sky_dome, scene, world);
  if (!light) return tl::unexpected(light.error());
  const auto same = check_same_scene("HOST", options.server, joined.welcome, scene);
  if (!same) return same;
  const RenderOptions render = render_options(options);
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  FrameSettings frame = frame_settings(render, *size);

  stream::LitScene lit(scene, world);
  if (options.codec == "h265") {
    auto reader = stream::make_h265_reader();
    if (!reader) return tl::unexpected(reader.error());
    lit.read_textures(std::move(*reader));
  }
  if (options.interest > 0.0f) {
    if (camera) {
      if (const auto sent = joined.client->send(*camera); !sent) return sent;
    }
    const auto sent = joined.client->send(stream::Interest{options.interest});
    if (!sent) return sent;
  }
  std::optional<Renderer> renderer;
  std::optional<float> stops = *parse_exposure(options.exposure);
  std::vector<std::string> written;
  RenderedFrame picture;
  const InterruptGuard guard;
  while (static_cast<int>(written.size()) < options.frames && !guard.interrupted()) {
    begin_step("receiving light");
    const auto came = wait_for_light(*joined.client, lit, settings.timeout);
    if (!came) return came;
    begin_step("rendering the picture");
    if (!renderer) renderer.emplace(world, IndirectSources{lit.field()});
    const Camera from = stream::camera_of(camera.value_or(joined.welcome.camera));
    if (!stops && shows_unlit(world.scene())) {
      // First find the exposure without unlit surfaces; these then show their colours at that
      // exposure
      frame.unlit_radiance = 0.0f;
      if (const auto done = renderer->render(from, frame, picture); !done) return done;
      stops = display_stops(picture.image);
    }
    if (stops && shows_unlit(world.scene())) {
      frame.unlit_radiance = radiance_of_colors(*tone_map_from_name(options.tone_map), *stops);
    }
    if (const auto done = renderer->render(from, frame, picture); !done) return done;
    const std::string path = name_of_frame(options, written.size());
    PictureFile file(render, path, *size, stops);
    if (const auto done = file.write(picture.image); !done) return done;
    if (const auto done = file.finish(); !done) return done;
    written.push_back(path);
  }
  if (written.empty()) return fail("", "", "was interrupted", Error::Kind::failed);
  tell_written(written, pixels_text(size->x, size->y), stops ? exposure_text(*stops) : "");
  return {};
}

}  // namespace lambent::cli
