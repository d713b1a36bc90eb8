// SPDX-License-Identifier: Apache-2.0
// Ghosts in a mirror: of a bright box that moves, and of a lamp that goes out.
#include <algorithm>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "bench/motion/left_over.h"
#include "bench/reflections/subject.h"
#include "bench/stage.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"

namespace lambent::reflections {
namespace {

constexpr int kWidth = 160, kHeight = 90;
constexpr int kFrames = 16;
// Of reference pictures. Their noise is a sixth of that of one sample.
constexpr int kTruthSamples = 32;

Camera view_of_mirror() {
  return look_at({0.0f, 1.4f, 1.5f}, {0.0f, 1.4f, -3.0f}, kViewAngle);
}

Image truth_of(const Subject& subject) {
  FrameSettings settings = quality_settings(Quality::high);
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = kTruthSamples;
  settings.seed = 1000;
  return *bench::value_or_throw(
              Renderer(subject.world, {.field = &subject.field}).render(view_of_mirror(), settings))
              .image.find("");
}

/// Renders frames of quality "interactive" after each `step`; returns their pictures.
class Sequence {
 public:
  explicit Sequence(Subject& subject)
      : subject_(subject), renderer_(subject.world, {.field = &subject.field}) {}

  /// Follows edits of the scene; renders a frame.
  const Image& next() {
    bench::value_or_throw(subject_.world.update());
    subject_.field.update(subject_.world);
    FrameSettings settings = quality_settings(Quality::interactive);
    settings.width = kWidth;
    settings.height = kHeight;
    settings.temporal_antialiasing = true;
    settings.seed = ++frames_;
    const Expected<void> done = renderer_.render(view_of_mirror(), settings, frame_);
    bench::value_or_throw(done);
    return *frame_.image.find("");
  }

 private:
  Subject& subject_;
  Renderer renderer_;
  RenderedFrame frame_;
  std::uint32_t frames_ = 0;
};

void print(const char* name, const motion::Left& left) {
  std::printf("| %s | %.2f %% | %.2f %% |\n", name, 100.0 * left.mean, 100.0 * left.largest);
  std::fflush(stdout);
}

/// A shining box passes behind the camera, some pixels a frame.
void measure_box() {
  Scene scene = room_with_plate(metal(0.0f));
  Material shining;
  shining.name = "shining";
  shining.unlit = true;
  shining.base_color = glm::vec4(1.0f, 0.9f, 0.7f, 1.0f);
  scene.materials.push_back(shining);
  scenes::MeshBuilder builder;
  builder.box(glm::vec3(-0.2f), glm::vec3(0.2f));
  const int box =
      scenes::add_object(scene, builder.take("box", static_cast<int>(scene.materials.size()) - 1));
  scene.instances[box].dynamic = true;
  const auto place = [box](Scene& of, int frame) {
    of.instances[box].world_from_object = glm::translate(
        glm::mat4(1.0f), glm::vec3(-0.8f + 0.1f * static_cast<float>(frame), 1.4f, 2.5f));
  };
  place(scene, 0);
  Subject subject(std::move(scene));
  Sequence sequence(subject);
  std::vector<Image> pictures;
  motion::Left sum;
  for (int i = 0; i < kFrames; ++i) {
    place(subject.scene, i);
    pictures.push_back(sequence.next());
    if (i < motion::kAfter) continue;
    const motion::Left left =
        motion::left_over(pictures[i - motion::kAfter], pictures.back(), truth_of(subject));
    sum.mean += left.mean / (kFrames - motion::kAfter);
    sum.largest = std::max(sum.largest, left.largest);
  }
  print("a shining box passes", sum);
}

/// The lamp, which the mirror shows, drops to a hundredth.
void measure_lamp() {
  Subject subject(room_with_plate(metal(0.0f)));
  Sequence sequence(subject);
  Image lit;
  for (int i = 0; i < kFrames; ++i) lit = sequence.next();
  for (Material& material : subject.scene.materials) material.emission *= 0.01f;
  Image after;
  for (int i = 0; i < motion::kAfter; ++i) after = sequence.next();
  print("the lamp goes out", motion::left_over(lit, after, truth_of(subject)));
}

}  // namespace

void measure_moved() {
  std::printf("### What a mirror shows of old light after %d frames\n", motion::kAfter);
  std::printf("| | mean | largest, of a pixel |\n|---|---|---|\n");
  measure_box();
  measure_lamp();
}

}  // namespace lambent::reflections
