// SPDX-License-Identifier: Apache-2.0
// Pictures of a local scene, in the light that a server sends.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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

/// Receives and answers messages until the light changes, or there is an interrupt.
Expected<void> wait_for_light(ServerSession& session, const InterruptGuard& guard,
                              stream::LitScene& lit) {
  const auto end = std::chrono::steady_clock::now() + session.timeout();
  for (;;) {
    const auto message = session.receive_until(end, guard);
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    // What a server says before it ends the connection is kept by the session
    if (std::holds_alternative<stream::Refusal>(**message)) continue;
    const auto followed = lit.follow(**message);
    if (!followed) return tl::unexpected(followed.error());
    if (followed->answer) {
      if (const auto sent = session.send(*followed->answer); !sent) return sent;
    }
    if (followed->lit) return {};
  }
  if (guard.interrupted()) return {};
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

/// Pictures of the options' scene in the light of a server.
class LitPictures {
 public:
  LitPictures(const ConnectOptions& options, std::unique_ptr<LocalScene>& local,
              const glm::ivec2& size, const std::optional<stream::CameraInput>& camera)
      : options_(options),
        local_(local),
        size_(size),
        camera_(camera),
        render_(render_options(options)),
        stops_(*parse_exposure(options.exposure)) {}

  /// Writes pictures until there are enough, the connection is lost, or there is an interrupt.
  /// Those written before stay.
  Expected<void> write(ServerSession& session, const InterruptGuard& guard) {
    if (const auto same = begin(session.welcome()); !same) return same;
    stream::LitScene lit(local_->opened.scene, local_->world);
    const auto done = write(session, guard, lit);
    // The next connection may be to a server that has restarted, and sends all edits in any case
    const auto restored = lit.restore();
    return done ? restored : done;
  }

  Expected<void> tell() const {
    if (written_.empty()) return {};
    tell_written(written_, pixels_text(size_.x, size_.y), stops_ ? exposure_text(*stops_) : "");
    return {};
  }

 private:
  /// Gives the scene the light of its server, with the first connection. The light that a server
  /// chooses suits its camera: one that has restarted with another camera gets another scene.
  Expected<void> begin(const stream::Welcome& welcome) {
    if (lit_for_ == welcome.camera) {
      return check_same_scene("HOST", options_.server, welcome, local_->opened.scene);
    }
    if (lit_for_) {
      auto again = open_local_scene(options_);
      if (!again) return tl::unexpected(again.error());
      local_ = std::move(*again);
    }
    lit_for_ = welcome.camera;
    return add_light_of_server("HOST", options_.server, welcome, options_.scene, local_->opened,
                               local_->world);
  }

  Expected<void> write(ServerSession& session, const InterruptGuard& guard, stream::LitScene& lit) {
    if (const auto asked = ask_for_light(session, lit); !asked) return asked;
    std::optional<Renderer> renderer;
    while (static_cast<int>(written_.size()) < options_.frames) {
      begin_step("receiving light");
      if (const auto came = wait_for_light(session, guard, lit); !came) return came;
      if (guard.interrupted()) break;
      begin_step("rendering the picture");
      if (!renderer) renderer.emplace(local_->world, IndirectSources{lit.field()});
      const Camera from = stream::camera_of(camera_.value_or(session.welcome().camera));
      if (const auto done = write_next(from, local_->world, *renderer); !done) return done;
      session.note_picture();
    }
    return {};
  }

  Expected<void> ask_for_light(ServerSession& session, stream::LitScene& lit) const {
    if (options_.codec == "h265") {
      auto reader = stream::make_h265_reader();
      if (!reader) return tl::unexpected(reader.error());
      lit.read_textures(std::move(*reader));
    }
    if (options_.interest <= 0.0f) return {};
    if (camera_) {
      if (const auto sent = session.send(*camera_); !sent) return sent;
    }
    return session.send(stream::Interest{options_.interest});
  }

  /// Renders and writes one picture.
  Expected<void> write_next(const Camera& from, const World& world, Renderer& renderer) {
    FrameSettings frame = frame_settings(render_, size_);
    if (!stops_ && shows_unlit(world.scene())) {
      // First find the exposure without unlit surfaces; these then show their colours at that
      // exposure
      frame.unlit_radiance = 0.0f;
      if (const auto done = renderer.render(from, frame, picture_); !done) return done;
      stops_ = display_stops(picture_.image);
    }
    if (stops_ && shows_unlit(world.scene())) {
      frame.unlit_radiance = radiance_of_colors(*tone_map_from_name(options_.tone_map), *stops_);
    }
    if (const auto done = renderer.render(from, frame, picture_); !done) return done;
    const std::string path = name_of_frame(options_, written_.size());
    PictureFile file(render_, path, size_, stops_);
    if (const auto done = file.write(picture_.image); !done) return done;
    if (const auto done = file.finish(); !done) return done;
    written_.push_back(path);
    return {};
  }

  const ConnectOptions& options_;
  std::unique_ptr<LocalScene>& local_;
  const glm::ivec2 size_;
  const std::optional<stream::CameraInput>& camera_;
  const RenderOptions render_;
  std::optional<float> stops_;
  std::optional<stream::CameraInput> lit_for_;  // the server's camera; none: no light yet
  std::vector<std::string> written_;
  RenderedFrame picture_;
};

}  // namespace

Expected<std::unique_ptr<LocalScene>> open_local_scene(const ConnectOptions& options) {
  begin_step("reading the scene");
  Expected<OpenedScene> opened = open_lit_scene(options.scene);
  if (!opened) return tl::unexpected(opened.error());
  begin_step("preparing the scene for rays");
  return std::make_unique<LocalScene>(std::move(*opened));
}

Expected<void> render_by_stream(const ConnectOptions& options, std::unique_ptr<LocalScene>& local,
                                ServerSession& session,
                                const std::optional<stream::CameraInput>& camera,
                                const InterruptGuard& guard) {
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  LitPictures pictures(options, local, *size, camera);
  const auto done = session.over_connections(guard, [&] { return pictures.write(session, guard); });
  return done ? pictures.tell() : done;
}

}  // namespace lambent::cli
