// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/memory.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/frame_renderer.h"
#include "lambent/help.h"
#include "lambent/input.h"
#include "lambent/memory_check.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/quality.h"
#include "lambent/render_options.h"
#include "lambent/render_output.h"
#include "lambent/render_sequence.h"
#include "lambent/step.h"
#include "lambent/threads.h"
#include "lambent/words.h"
#include "lambent/world.h"

namespace lambent::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRenderExamples =
    "  lambent render scene.glb                     write scene.png, with everything chosen\n"
    "  lambent render scene.glb --size 1080p --sun=0.3,-1,0.2 -o pictures/day.jpg\n"
    "  lambent render scene.glb --eye 2,1.7,3 --target 0,1,0 --layers -o layers.exr\n";

Expected<void> render_picture(const RenderOptions& options, const World& world,
                              const Camera& camera, FrameRenderer& renderer, Json& stats) {
  std::optional<float> stops;
  if (const auto made = make_folders(options.output); !made) return made;
  const auto done = renderer.paint_to_file(camera, options.output, stops, stats);
  if (!done) return done;
  tell_written(options.output, pixels_text(renderer.size().x, renderer.size().y),
               stops ? exposure_text(*stops) : "");
  if (options.verify_samples == 0) return {};
  if (world.device() == nullptr) return renderer.verify(world, camera, stats);
  return renderer.verify(World(world.scene()), camera, stats);
}

/// The index of the animation that the options name; -1: all of them.
Expected<int> chosen_animation(const RenderOptions& options, const Scene& scene) {
  if (options.animation.empty()) return -1;
  std::vector<std::string> names;
  for (const Animation& known : scene.animations) names.push_back(known.name);
  if (const auto index = index_of(options.animation, names)) return static_cast<int>(*index);
  return fail("--animation", "", no_such("animation", options.animation, names));
}

/// Poses the scene at the time of the options, which may be a sequence's start.
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
  if (const auto fine = check_scene_input(options.scene.file); !fine) return fine;
  if (const auto fine = check_outputs(options); !fine) return fine;
  if (const auto fine = check_options(options); !fine) return fine;
  const auto size = parse_size("--size", options.size);
  if (!size) return tl::unexpected(size.error());
  if (const auto fits = check_picture_memory(options, *size, available_memory()); !fits)
    return fits;
  if (options.most_samples > 0 && made_in_bands(options, *size)) {
    return fail("--most-samples", "", "goes with pictures of up to two million pixels");
  }
  const ThreadLimit limit(options.threads);

  const auto device = open_backend(options.backend);
  if (!device) return tl::unexpected(device.error());

  begin_step("reading the scene");
  SceneOptions input = options.scene;
  input.no_fog = leaves_out(options, "fog");
  Expected<OpenedScene> opened = open_lit_scene(input);
  if (!opened) return tl::unexpected(opened.error());
  Scene& scene = opened->scene;
  const auto animation = chosen_animation(options, scene);
  if (!animation) return tl::unexpected(animation.error());
  if (const auto posed = pose(options, *animation, scene); !posed) return posed;
  begin_step("preparing the scene for rays");
  World world(scene, *device);
  const float aspect = static_cast<float>(size->x) / static_cast<float>(size->y);
  const PosedScene unlit{scene, world, *animation, false};
  const Expected<View> view =
      choose_view(options.scene, world, aspect, poses_of_sequence(options, unlit));
  if (!view) return tl::unexpected(view.error());
  std::optional<FirstLight> chosen;
  if (options.frames > 0 && options.scene.light.light == "auto" && !opened->sky_dome) {
    const auto suits = choose_light_of_sequence(options, unlit, *view);
    if (!suits) return tl::unexpected(suits.error());
    chosen = *suits;
  }
  const auto light =
      add_first_light(options.scene.light, view->camera, opened->sky_dome, scene, world, chosen);
  if (!light) return tl::unexpected(light.error());
  tell("camera: " + describe(*view));
  tell("light: " + light->description);

  Json stats;
  stats["method"] = options.method;
  stats["backend"] = options.backend.name;
  if (*device != nullptr) stats["device"] = vulkan::description(**device).name;
  stats["width"] = size->x;
  stats["height"] = size->y;
  stats["triangles"] = triangle_count(scene);
  stats["build_ms"] = world.build_ms();
  stats["acceleration_structure_bytes"] = world.bytes();

  FrameRenderer renderer(options, world, *size);
  const Expected<void> done =
      options.frames > 0
          ? render_sequence(options, {scene, world, *animation, light->kind == FirstLight::sky},
                            *view, renderer, stats)
          : render_picture(options, world, view->camera, renderer, stats);
  if (const auto silent = check_validation(device->get()); done && !silent) return silent;
  // For an interrupted sequence, write the statistics of the finished frames
  if (options.stats.empty() || (!done && options.frames == 0)) return done;
  const auto told = write_statistics(options.stats, stats);
  return done ? told : done;
}

}  // namespace

void add_render(CLI::App& app, Run& run) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Render a picture of a scene, or a sequence");
  add_render_options(*command, *options);
  command->group(kPictureGroup);
  set_examples(*command, kRenderExamples);
  command->callback([options, &run] {
    if (options->output.empty()) options->output = picture_beside(options->scene.file);
    run = [options] { return render(*options); };
  });
}

}  // namespace lambent::cli
