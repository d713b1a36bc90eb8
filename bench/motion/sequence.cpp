// SPDX-License-Identifier: Apache-2.0
#include "bench/motion/sequence.h"

#include <array>
#include <cstdio>
#include <cstdlib>

#include "bench/stage.h"
#include "core/image/metrics.h"
#include "core/image/tone_map.h"
#include "lambent/first_picture.h"
#include "scenes/builtin.h"

namespace lambent::motion {
namespace {

// Updates of the field, enough for its light to settle.
constexpr int kUpdates = 8;
// Samples of reference pictures: the error at edges is a thirtieth of their contrast.
constexpr int kTruthSamples = 32;
constexpr int kBlock = 8;

IrradianceField lit_field(const World& world) {
  FieldSettings settings;
  settings.rays_per_probe = 96;
  IrradianceField field =
      bench::value_or_throw(IrradianceField::make(settings, open_bounds(world)));
  for (int i = 0; i < kUpdates; ++i) field.update(world);
  return field;
}

}  // namespace

Subject::Subject(const std::string& name)
    : scene(bench::open_stage(name)),
      world(scene),
      field(lit_field(world)),
      camera(scenes::make(name) ? scene.cameras.front()
                                : bench::value_or_throw(first_view(world)).camera) {}

void Subject::apply_edits() {
  bench::value_or_throw(world.update());
  field.update(world);
}

FrameError error_of(const Image& picture, const Image& truth) {
  const Metrics pixels = bench::value_or_throw(compare_images(picture, truth));
  const Metrics blocks =
      bench::value_or_throw(compare_images(picture, truth, {.block = kBlock, .perceptual = false}));
  return {pixels.relative_rmse, blocks.relative_rmse, pixels.flip, pixels.mean_ratio};
}

FrameError mean_of(const std::vector<FrameError>& errors) {
  FrameError mean;
  const auto count = static_cast<double>(errors.size());
  for (const FrameError& error : errors) {
    mean.per_pixel += error.per_pixel / count;
    mean.blocks += error.blocks / count;
    mean.flip += error.flip / count;
    mean.mean_ratio += error.mean_ratio / count;
  }
  return mean;
}

Image truth_of(const Subject& subject, const Camera& camera) {
  IndirectSources sources;
  sources.field = &subject.field;
  FrameSettings settings = settings_of(1 << 20, false);
  settings.samples = kTruthSamples;
  return *bench::value_or_throw(Renderer(subject.world, sources).render(camera, settings))
              .image.find("");
}

FrameSettings settings_of(int frame, bool antialiased) {
  FrameSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.seed = 1u + static_cast<std::uint32_t>(frame);
  settings.temporal_antialiasing = antialiased;
  return settings;
}

void keep_picture(const Image& picture, const std::string& name, int frame) {
  const char* folder = std::getenv("LAMBENT_PICTURES");
  if (folder == nullptr) return;
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), ".%04d.png", frame);
  constexpr float kStops = 0.0f;
  bench::value_or_throw(write_png(std::string(folder) + "/" + name + number.data(),
                                  display_image(picture, ToneMap::aces, kStops)));
}

}  // namespace lambent::motion
