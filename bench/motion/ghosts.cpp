// SPDX-License-Identifier: Apache-2.0
// Ghosts of earlier frames: of a bright box that moves, and of a lamp that goes out.
#include <algorithm>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/motion/left_over.h"
#include "bench/motion/sequence.h"
#include "bench/stage.h"

namespace lambent::motion {
namespace {

constexpr int kMostFrames = 16;

/// An emissive box that crosses the court of the atrium, some pixels per frame.
void measure_box() {
  Subject subject("atrium");
  Material shining;
  shining.name = "shining";
  shining.unlit = true;
  shining.base_color = glm::vec4(1.0f, 0.9f, 0.7f, 1.0f);
  subject.scene.materials.push_back(shining);
  Mesh box;
  box.material = static_cast<int>(subject.scene.materials.size()) - 1;
  for (int i = 0; i < 8; ++i) {
    box.positions.emplace_back((i & 1) != 0 ? 0.5f : -0.5f, (i & 2) != 0 ? 0.5f : -0.5f,
                               (i & 4) != 0 ? 0.5f : -0.5f);
    box.normals.push_back(glm::normalize(box.positions.back()));
  }
  box.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  Instance placed;
  placed.name = "shining box";
  placed.mesh = static_cast<int>(subject.scene.meshes.size());
  placed.dynamic = true;
  subject.scene.meshes.push_back(std::move(box));
  subject.scene.instances.push_back(placed);

  IndirectSources sources;
  sources.field = &subject.field;
  Renderer renderer(subject.world, sources);
  RenderedFrame frame;
  const Camera& camera = subject.camera;
  std::vector<Image> pictures;
  Left worst;
  double mean = 0.0;
  int counted = 0;
  for (int i = 0; i < kMostFrames; ++i) {
    subject.scene.instances.back().world_from_object =
        glm::translate(glm::mat4(1.0f), {-1.0f, 1.2f, -2.4f + 0.25f * static_cast<float>(i)});
    subject.apply_edits();
    const Expected<void> done = renderer.render(camera, settings_of(i, true), frame);
    bench::value_or_throw(done);
    pictures.push_back(*frame.image.find(""));
    keep_picture(pictures.back(), "box", i);
    if (i < kAfter) continue;
    const Left left = left_over(pictures[i - kAfter], pictures[i], truth_of(subject, camera));
    mean += left.mean;
    worst.largest = std::max(worst.largest, left.largest);
    ++counted;
  }
  std::printf("| a shining box crosses the atrium | %.2f %% | %.2f %% |\n", 100.0 * mean / counted,
              100.0 * worst.largest);
}

/// All lamps of a scene drop to a hundredth at once.
void measure_lamp(const char* name) {
  Subject subject(name);
  IndirectSources sources;
  sources.field = &subject.field;
  Renderer renderer(subject.world, sources);
  RenderedFrame frame;
  const Camera& camera = subject.camera;
  Image lit;
  for (int i = 0; i < kMostFrames + kAfter; ++i) {
    if (i == kMostFrames) {
      for (Light& light : subject.scene.lights) light.intensity *= 0.01f;
      subject.apply_edits();
    }
    const Expected<void> done = renderer.render(camera, settings_of(i, true), frame);
    bench::value_or_throw(done);
    if (i == kMostFrames - 1) lit = *frame.image.find("");
  }
  const Left left = left_over(lit, *frame.image.find(""), truth_of(subject, camera));
  std::printf("| the lights of %s go out | %.2f %% | %.2f %% |\n", name, 100.0 * left.mean,
              100.0 * left.largest);
}

}  // namespace

void measure_ghosts() {
  std::printf("### What is left of old light after %d frames\n", kAfter);
  std::printf("| | mean | largest, of a pixel |\n|---|---|---|\n");
  measure_box();
  measure_lamp("cornell-spot");
  measure_lamp("two-rooms");
}

}  // namespace lambent::motion
