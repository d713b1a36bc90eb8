// SPDX-License-Identifier: Apache-2.0
// The number of updates until light has followed an edit.
#include <cstdio>

#include "bench/dynamics/subject.h"

namespace lambent::dynamics {
namespace {

constexpr int kUpdatesBefore = 16;
constexpr int kUpdatesAfter = 4;
constexpr int kPixels = 96;

FieldSettings nine_cubed() {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(9);
  settings.rays_per_probe = 256;
  return settings;
}

template <class Edit>
void follow(const char* label, Edit edit) {
  Subject cornell("cornell", nine_cubed());
  for (int i = 0; i < kUpdatesBefore; ++i) cornell.field.update(cornell.world);
  edit(cornell);
  cornell.apply_edits();
  const std::vector<FieldQuery> points = seen_points(cornell, kPixels);
  const std::vector<double> settled = light_at(cornell.settled_field(), points);
  Difference difference = compare(light_at(cornell.field, points), settled);
  std::printf("| %s | 0 | | %.4f | %.4f |\n", label, difference.mean_ratio,
              difference.relative_rmse);
  for (int i = 1; i <= kUpdatesAfter; ++i) {
    const UpdateStatistics statistics = cornell.field.update(cornell.world);
    difference = compare(light_at(cornell.field, points), settled);
    std::printf("| %s | %d | %llu + %llu | %.4f | %.4f |\n", label, i,
                static_cast<unsigned long long>(statistics.probe_rays),
                static_cast<unsigned long long>(statistics.shadow_rays), difference.mean_ratio,
                difference.relative_rmse);
  }
}

}  // namespace

void measure_step() {
  std::printf("### Updates from an edit to the settled light, cornell, 9x9x9 probes, 256 rays\n");
  std::printf("| edit | update | probe + shadow rays | mean E over settled | relative RMSE |\n");
  std::printf("|---|---|---|---|---|\n");
  follow("lamp three times as bright", [](Subject& subject) {
    for (Material& material : subject.scene.materials) material.emission *= 3.0f;
  });
  follow("lamp dimmed to 1 %", [](Subject& subject) {
    for (Material& material : subject.scene.materials) material.emission *= 0.01f;
  });
  follow("tall block moved by 0.42 m", [](Subject& subject) {
    subject.move("tall_block", {0.3f, 0.0f, 0.3f});
  });
}

}  // namespace lambent::dynamics
