// SPDX-License-Identifier: Apache-2.0
// Median times of an update and a frame of quality "interactive" while something moves.
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/median.h"
#include "bench/rows.h"
#include "bench/stage.h"
#include "core/stopwatch.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/world.h"

namespace lambent::bench {
namespace {

constexpr int kUpdatesBefore = 8;
// Frames that are not counted: they have no history, and updates have not measured their cost yet.
constexpr int kFramesBefore = 3, kFrames = 8;
constexpr double kUpdateBudget = 30.0;  // [ms]

/// A scene with a field and a renderer.
struct Subject {
  explicit Subject(Scene made)
      : scene(std::move(made)),
        world(scene),
        field(value_or_throw(IrradianceField::make({}, open_bounds(world)))) {
    for (int i = 0; i < kUpdatesBefore; ++i) field.update(world);
  }
  Scene scene;
  World world;
  IrradianceField field;
};

using Table = std::map<std::string, Median>;

void add(Table& table, const std::string& of, const std::vector<PassTime>& passes) {
  for (const PassTime& pass : passes) table[of + " " + pass.name].add(pass.ms);
}

void print(const Table& table) {
  std::printf("| pass | ms |\n|---|---|\n");
  for (const auto& [name, ms] : table) {
    if (ms.value() >= 0.5) std::printf("| %s | %.1f |\n", name.c_str(), ms.value());
  }
}

/// Alternately moves something and renders a frame.
template <class Move>
Table measure(Subject& subject, const Camera& camera, double update_budget_ms, Move move) {
  IndirectSources sources;
  sources.field = &subject.field;
  Renderer renderer(subject.world, sources);
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = 640;
  settings.height = 360;
  settings.temporal_antialiasing = true;
  settings.averaged_frames = 10;
  RenderedFrame frame;
  Table table;
  for (int i = 0; i < kFramesBefore + kFrames; ++i) {
    if (i == kFramesBefore) table.clear();
    settings.seed = 1u + static_cast<std::uint32_t>(i);
    move(i);
    Stopwatch watch;
    value_or_throw(subject.world.update());
    const double edit_ms = watch.lap();
    const UpdateStatistics updated = subject.field.update(
        subject.world,
        {.time_budget_ms = update_budget_ms, .viewer_ws = glm::vec3(camera.world_from_view[3])});
    const double update_ms = watch.lap();
    value_or_throw(renderer.render(camera, settings, frame));
    const double frame_ms = watch.lap();
    table["all"].add(edit_ms + update_ms + frame_ms);
    table["update"].add(update_ms);
    table["frame"].add(frame_ms);
    add(table, "update:", updated.passes);
    add(table, "frame:", frame.passes);
  }
  return table;
}

/// The nave of Sponza, if available, under a sun that moves by half a degree per frame.
void measure_sun() {
  const char* shared = std::getenv("LAMBENT_SHARED");
  const std::string folder = shared != nullptr ? shared : "../shared";
  Scene scene = open_stage(folder + "/scenes/Sponza/Sponza.gltf");
  Subject subject(std::move(scene));
  const Camera camera = look_at({8.0f, 2.0f, -0.3f}, {-8.0f, 4.0f, 0.0f}, glm::radians(70.0f));
  Light& sun = subject.scene.lights.back();
  const glm::vec3 noon = glm::normalize(glm::vec3(-0.3f, -0.9f, 0.2f));
  std::printf("### Sponza's nave, 640x360, moving sun, updates of %.0f ms\n", kUpdateBudget);
  print(measure(subject, camera, kUpdateBudget, [&](int i) {
    const glm::mat4 turn =
        glm::rotate(glm::mat4(1.0f), glm::radians(0.5f * static_cast<float>(i)), {0, 0, 1});
    sun.direction_ws = glm::vec3(turn * glm::vec4(noon, 0.0f));
  }));
}

/// The tall block of the Cornell box, which moves by 2 cm per frame; updates have no time limit.
void measure_block() {
  constexpr double kEnough = 10000.0;  // [ms]
  Subject subject(open_stage("cornell"));
  Instance& block = subject.scene.instances.back();
  std::printf("### Cornell box, 640x360, a block moves\n");
  const glm::mat4 before = block.world_from_object;
  print(measure(subject, subject.scene.cameras.front(), kEnough, [&](int i) {
    block.world_from_object =
        glm::translate(glm::mat4(1.0f), {0.02f * static_cast<float>(i % 8), 0.0f, 0.0f}) * before;
  }));
}

}  // namespace
}  // namespace lambent::bench

int main(int argc, char** argv) {
  using namespace lambent::bench;
  return run_rows("lambent_frames", {{"sun", measure_sun}, {"block", measure_block}}, argc, argv);
}
