// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.h"
#include "lambent/commands.h"
#include "lambent/frame_renderer.h"
#include "lambent/parse.h"
#include "lambent/render_options.h"
#include "lambent/render_output.h"
#include "lambent/render_sequence.h"
#include "lambent/threads.h"
#include "lambent/world.h"

namespace lambent::cli {
namespace {

using Json = nlohmann::ordered_json;

Expected<void> render_picture(const RenderOptions& options, const World& world,
                              FrameRenderer& renderer, Json& stats) {
  const Expected<Camera> camera = choose_camera(options.stage, world);
  if (!camera) return tl::unexpected(camera.error());
  const Expected<LayeredImage> image = renderer.paint(world, *camera, stats);
  if (!image) return tl::unexpected(image.error());
  std::optional<float> stops;
  const auto done = write_output(options, *image, options.output, stops);
  if (!done || options.verify_samples == 0) return done;
  if (world.on_device() == nullptr) return renderer.verify(world, *camera, *image, stats);
  return renderer.verify(World(world.scene()), *camera, *image, stats);
}

/// The animation that the options name; -1: all of them.
Expected<int> chosen_animation(const RenderOptions& options, const Scene& scene) {
  if (options.animation.empty()) return -1;
  std::string known;
  for (int i = 0; i < static_cast<int>(scene.animations.size()); ++i) {
    const std::string& name = scene.animations[i].name;
    if (options.animation == name || options.animation == std::to_string(i)) return i;
    known += (i == 0 ? "" : ", ") + std::to_string(i) + " " + name;
  }
  return fail("--animation", "",
              "no animation '" + options.animation + "'; the scene has " +
                  (known.empty() ? std::string("none") : known));
}

/// Poses the scene at the time that the options ask for, a sequence's start included.
Expected<void> pose(const RenderOptions& options, int animation, Scene& scene) {
  if (options.time_s && scene.animations.empty()) {
    return fail("--time", "", "the scene has no animation that can be played");
  }
  if (options.time_s || options.frames > 0) {
    animate(scene, animation, options.time_s.value_or(0.0f));
  }
  return {};
}

Expected<void> render(const RenderOptions& options) {
  if (const auto fine = check_outputs(options); !fine) return fine;
  if (const auto fine = check_options(options); !fine) return fine;
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  const ThreadLimit limit(options.threads);

  const auto device = open_backend(options.backend);
  if (!device) return tl::unexpected(device.error());

  Expected<Scene> scene = open_stage(options.stage);
  if (!scene) return tl::unexpected(scene.error());
  const auto animation = chosen_animation(options, *scene);
  if (!animation) return tl::unexpected(animation.error());
  if (const auto posed = pose(options, *animation, *scene); !posed) return posed;
  World world(*scene, *device);

  Json stats;
  stats["method"] = options.method;
  stats["backend"] = options.backend.name;
  if (*device != nullptr) stats["device"] = vulkan::description(**device).name;
  stats["width"] = size->x;
  stats["height"] = size->y;
  stats["triangles"] = triangle_count(*scene);
  stats["build_ms"] = world.build_ms();
  stats["acceleration_structure_bytes"] = world.bytes();

  FrameRenderer renderer(options, *size);
  const Expected<void> done =
      options.frames > 0 ? render_sequence(options, *scene, *animation, world, renderer, stats)
                         : render_picture(options, world, renderer, stats);
  if (const auto silent = check_validation(device->get()); done && !silent) return silent;
  // Of a sequence that was interrupted, what was done is told
  if (options.stats.empty() || (!done && options.frames == 0)) return done;
  const auto told = write_file_atomically(options.stats, stats.dump(2) + "\n");
  return done ? told : done;
}

}  // namespace

void add_render(CLI::App& app, Run& run) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Render a picture of a scene, or a sequence");
  add_render_options(*command, *options);
  command->callback([options, &run] { run = [options] { return render(*options); }; });
}

}  // namespace lambent::cli
