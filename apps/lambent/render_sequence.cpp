// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_sequence.h"

#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>

#include "lambent/render_output.h"

namespace lambent::cli {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

/// While it lives, the first interrupt is noted only.
class InterruptGuard {
 public:
  InterruptGuard() {
    interrupted = false;
    struct sigaction note {};
    note.sa_handler = [](int) { interrupted = true; };
    note.sa_flags = SA_RESETHAND | SA_RESTART;
    sigaction(SIGINT, &note, &old_interrupt_);
    sigaction(SIGTERM, &note, &old_terminate_);
  }
  ~InterruptGuard() {
    sigaction(SIGINT, &old_interrupt_, nullptr);
    sigaction(SIGTERM, &old_terminate_, nullptr);
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  struct sigaction old_interrupt_ {
  }, old_terminate_{};
};

}  // namespace

Expected<void> render_sequence(const RenderOptions& options, Scene& scene, int animation,
                               World& world, FrameRenderer& renderer,
                               nlohmann::ordered_json& stats) {
  const InterruptGuard guard;
  stats["fps"] = options.fps;
  nlohmann::ordered_json& list = stats["frames"] = nlohmann::ordered_json::array();
  std::optional<float> stops;
  std::optional<Camera> camera;
  for (int i = 0; i < options.frames; ++i) {
    if (interrupted) {
      return fail("", "", "interrupted after " + std::to_string(i) + " frames",
                  Error::Kind::failed);
    }
    const double time =
        static_cast<double>(options.time_s.value_or(0.0f)) + i / static_cast<double>(options.fps);
    animate(scene, animation, static_cast<float>(time));
    const Expected<WorldChanges> changes = world.update();
    if (!changes) return tl::unexpected(changes.error());

    // A camera of the scene moves along; one that was fitted to the scene stays where it is
    if (!camera || (!scene.cameras.empty() && options.stage.eye.empty())) {
      Expected<Camera> chosen = choose_camera(options.stage, world);
      if (!chosen) return tl::unexpected(chosen.error());
      camera = std::move(*chosen);
    }
    nlohmann::ordered_json& frame = list.emplace_back();
    frame["frame"] = i;
    frame["time_s"] = time;
    frame["world_update_ms"] = changes->refit_ms;
    frame["moved_boxes"] = changes->moved.size();
    frame["changed_lights"] = changes->lights.size();
    const Expected<LayeredImage> image = renderer.paint(world, *camera, frame);
    if (!image) return tl::unexpected(image.error());
    const auto done = write_output(options, *image, frame_path(options.output, i), stops);
    if (!done) return done;
  }
  return {};
}

}  // namespace lambent::cli
