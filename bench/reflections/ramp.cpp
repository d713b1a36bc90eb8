// SPDX-License-Identifier: Apache-2.0
// The largest step of what a metal plate reflects from one roughness to the next.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "bench/reflections/subject.h"
#include "scenes/procedural_textures.h"
#include "shared/constants.h"

namespace lambent::reflections {
namespace {

constexpr int kSteps = 64;
constexpr int kRampSide = 32;  // of pictures [pixels]
constexpr Samples kRampSamples{16, 256};
// The field holds all bounces after one update; its noise, of the same rays at each step, cancels.
constexpr int kUpdates = 2;
constexpr glm::ivec3 kProbes{7, 5, 9};

struct View {
  const char* name;
  glm::vec3 eye, target;
};
// The second sees the plate at 75 to 83 degrees to its normal.
constexpr View kViews[] = {{"facing", {0.0f, 1.4f, 1.5f}, {0.0f, 1.2f, -3.0f}},
                           {"grazing", {1.9f, 1.4f, -2.5f}, {-1.5f, 1.3f, -2.9f}}};

/// A relief of ribs, tilted by up to 0.3.
Texture ribs() {
  constexpr int kTexels = 256;
  constexpr float kRibs = 8.0f, kTilt = 0.3f;
  return scenes::bake("ribs", kTexels, 1.0f,
                      [](glm::vec2 p) {
                        const float turn = kTwoPi * kRibs;
                        return scenes::Texel{.height = kTilt / turn * std::sin(turn * p.x)};
                      })
      .normal;
}

double mean_of(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

/// The largest relative change of a mean from one roughness to the next.
class Steps {
 public:
  void add(double mean) {
    if (before_ > 0.0) largest_ = std::max(largest_, std::abs(mean / before_ - 1.0));
    before_ = mean;
  }
  double largest() const { return largest_; }

 private:
  double before_ = 0.0, largest_ = 0.0;
};

void measure(const View& view, bool ribbed) {
  FieldSettings settings;
  settings.probe_count = kProbes;
  Steps ours, reference;
  for (int i = 0; i < kSteps; ++i) {
    Material plate = metal(static_cast<float>(i) / (kSteps - 1));
    if (ribbed) plate.normal_texture.texture = 0;
    Scene scene = room_with_plate(plate);
    if (ribbed) scene.textures.push_back(ribs());
    const Subject subject(std::move(scene), settings, kUpdates);
    const Camera camera = look_at(view.eye, view.target, kViewAngle);
    const Reflected found = reflected_in(subject, camera, kRampSide, kRampSamples);
    ours.add(mean_of(found.ours));
    reference.add(mean_of(found.reference));
  }
  std::printf("| %s, %s | %.4f | %.4f | %.2f |\n", view.name, ribbed ? "normal map" : "flat",
              ours.largest(), reference.largest(), ours.largest() / reference.largest());
  std::fflush(stdout);
}

}  // namespace

void measure_ramps() {
  std::printf("### Largest step of a plate's reflections, roughness 0 to 1 in %d steps\n", kSteps);
  std::printf("| plate | ours | reference | ratio |\n|---|---|---|---|\n");
  for (const View& view : kViews) {
    for (const bool ribbed : {false, true}) measure(view, ribbed);
  }
}

}  // namespace lambent::reflections
