// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_sequence.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lambent/console.h"
#include "lambent/interrupts.h"
#include "lambent/output.h"
#include "lambent/render_output.h"
#include "lambent/words.h"

namespace lambent::cli {

Expected<void> render_sequence(const RenderOptions& options, Scene& scene, int animation, View view,
                               World& world, FrameRenderer& renderer,
                               nlohmann::ordered_json& stats) {
  const InterruptGuard guard;
  stats["fps"] = options.fps;
  nlohmann::ordered_json& list = stats["frames"] = nlohmann::ordered_json::array();
  std::optional<float> stops;
  std::vector<std::string> written;
  for (int i = 0; i < options.frames; ++i) {
    if (guard.interrupted()) {
      return fail("", "", "interrupted after " + std::to_string(i) + " frames",
                  Error::Kind::failed);
    }
    const double time =
        static_cast<double>(options.time_s.value_or(0.0f)) + i / static_cast<double>(options.fps);
    animate(scene, animation, static_cast<float>(time));
    const Expected<WorldChanges> changes = world.update();
    if (!changes) return tl::unexpected(changes.error());

    // A camera of the scene follows the animation; any other does not move, nor does any where
    // nothing is animated
    if (view.from == View::From::scene && !scene.animations.empty()) {
      Expected<Camera> moved = camera_of_scene(options.scene, scene);
      if (!moved) return tl::unexpected(moved.error());
      view.camera = std::move(*moved);
    }
    nlohmann::ordered_json& frame = list.emplace_back();
    frame["frame"] = i;
    frame["time_s"] = time;
    frame["world_update_ms"] = changes->refit_ms;
    frame["moved_boxes"] = changes->moved.size();
    frame["changed_lights"] = changes->lights.size();
    written.push_back(frame_path(options.output, i));
    if (const auto made = make_folders(written.back()); !made) return made;
    const auto done = renderer.paint_to_file(view.camera, written.back(), stops, frame);
    if (!done) return done;
  }
  tell_written(written, pixels_text(renderer.size().x, renderer.size().y),
               stops ? exposure_text(*stops) : "");
  return {};
}

}  // namespace lambent::cli
