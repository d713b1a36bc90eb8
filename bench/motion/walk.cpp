// SPDX-License-Identifier: Apache-2.0
// Frames of a camera that walks and turns, and of one at rest, compared to the mean of many
// samples.
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/motion/sequence.h"
#include "bench/stage.h"

namespace lambent::motion {
namespace {

// A step of a person at 30 frames a second [m], and a turn of the head [rad].
constexpr float kStep = 0.045f, kTurn = 0.015f;
// One in kEvery frames is compared to the reference, after the first ones, in which the history
// fills.
constexpr int kEvery = 4, kFirstFrames = 7;

Camera walk(const Camera& start, int frame) {
  Camera camera = start;
  const auto steps = static_cast<float>(frame);
  const glm::vec3 ahead = -glm::vec3(start.world_from_view[2]);
  const glm::vec3 level = glm::normalize(glm::vec3(ahead.x, 0.0f, ahead.z));
  camera.world_from_view =
      glm::translate(glm::mat4(1.0f), steps * kStep * level) * camera.world_from_view;
  return camera;
}

Camera turn(const Camera& start, int frame) {
  Camera camera = start;
  camera.world_from_view =
      camera.world_from_view *
      glm::rotate(glm::mat4(1.0f), kTurn * static_cast<float>(frame), {0.0f, 1.0f, 0.0f});
  return camera;
}

Camera rest(const Camera& start, int) {
  return start;
}

struct Path {
  const char* name;
  Camera (*at)(const Camera& start, int frame);
};

FrameError measure(const Subject& subject, const std::string& label, const Path& path,
                   bool antialiased) {
  IndirectSources sources;
  sources.field = &subject.field;
  Renderer renderer(subject.world, sources);
  RenderedFrame frame;
  std::vector<FrameError> errors;
  Image truth;
  for (int i = 0; i < kFrames; ++i) {
    const Camera camera = path.at(subject.camera, i);
    const Expected<void> done = renderer.render(camera, settings_of(i, antialiased), frame);
    bench::value_or_throw(done);
    const Image& picture = *frame.image.find("");
    keep_picture(picture, label + "." + path.name + (antialiased ? ".taa" : ".raw"), i);
    if (i < kFirstFrames || (i - kFirstFrames) % kEvery != 0) continue;
    if (i == kFirstFrames || path.at != rest) truth = truth_of(subject, camera);
    errors.push_back(error_of(picture, truth));
  }
  return mean_of(errors);
}

void measure_scene(const std::string& name, const std::string& label) {
  const Subject subject(name);
  constexpr Path kPaths[] = {{"rest", rest}, {"walk", walk}, {"turn", turn}};
  double at_rest = 0.0;
  for (const Path& path : kPaths) {
    const FrameError raw = measure(subject, label, path, false);
    const FrameError filtered = measure(subject, label, path, true);
    if (path.at == rest) at_rest = filtered.blocks;
    std::printf("| %s, %s | %.3f | %.3f | %.4f | %.4f | %.4f | %.2f | %.4f |\n", label.c_str(),
                path.name, raw.per_pixel, filtered.per_pixel, raw.flip, filtered.flip,
                filtered.blocks, filtered.blocks / at_rest, filtered.mean_ratio);
  }
}

}  // namespace

void measure_walk() {
  std::printf("### Each %dth of %d frames of %dx%d, a sample a pixel, against means of many\n",
              kEvery, kFrames, kWidth, kHeight);
  std::printf(
      "| scene, camera | RMSE of pixels, raw | filtered | FLIP, raw | filtered | RMSE of "
      "8x8, filtered | over rest | mean |\n|---|---|---|---|---|---|---|---|\n");
  measure_scene("atrium", "atrium");
  if (const char* sponza = std::getenv("LAMBENT_SPONZA")) measure_scene(sponza, "Sponza");
}

void measure_still() {
  std::printf("### From frame to frame, nothing moving, after 16 frames\n");
  std::printf("| scene | FLIP, raw | filtered | RMSE of 8x8, raw | filtered |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const char* name : {"cornell", "atrium"}) {
    const Subject subject(name);
    IndirectSources sources;
    sources.field = &subject.field;
    FrameError means[2];
    for (const bool antialiased : {false, true}) {
      Renderer renderer(subject.world, sources);
      RenderedFrame frame;
      Image before;
      std::vector<FrameError> changes;
      for (int i = 0; i < kFrames; ++i) {
        const Expected<void> done =
            renderer.render(subject.camera, settings_of(i, antialiased), frame);
        bench::value_or_throw(done);
        const Image& picture = *frame.image.find("");
        if (i > 16) changes.push_back(error_of(picture, before));
        before = picture;
      }
      means[antialiased ? 1 : 0] = mean_of(changes);
    }
    std::printf("| %s | %.4f | %.4f | %.4f | %.4f |\n", name, means[0].flip, means[1].flip,
                means[0].blocks, means[1].blocks);
  }
}

}  // namespace lambent::motion
