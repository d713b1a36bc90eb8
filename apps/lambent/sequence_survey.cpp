// SPDX-License-Identifier: Apache-2.0
#include "lambent/sequence_survey.h"

#include <algorithm>
#include <cmath>

#include "core/image/exposure.h"
#include "lambent/animation.h"
#include "lambent/first_picture.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/quality.h"
#include "lambent/step.h"
#include "reference/path_tracer.h"

namespace lambent::cli {
namespace {

// Number of frames that are looked at, the first and the last among them.
constexpr int kSurveyed = 9;
// Longer side of the pictures from which exposures are found [pixels], and paths a pixel. Noise
// makes the mean of logarithms too dark: in a room lit through a door by 0.1 stops, with twice the
// side and a quarter of the paths by 0.3.
constexpr int kExposedSide = 32, kExposedSamples = 256;
// An exposure that differs by less from the first frame's is not worth a change [stops].
constexpr float kMinDifference = 1.0f;

/// Whether the program chooses the exposure of the sequence.
bool chooses_exposure(const RenderOptions& options) {
  const auto asked = parse_exposure(options.exposure);
  return asked && !*asked && !has_ending(options.output, ".exr");
}

/// The exposure that suits a pose [stops].
float exposure_of_pose(const World& world, const Camera& camera, const RenderOptions& options) {
  const glm::vec2 size(*parse_size("--size", options.size));
  const float scale = std::min(1.0f, kExposedSide / std::max(size.x, size.y));
  ReferenceSettings settings;
  settings.width = std::max(1, static_cast<int>(std::lround(scale * size.x)));
  settings.height = std::max(1, static_cast<int>(std::lround(scale * size.y)));
  settings.samples = kExposedSamples;
  settings.unlit_radiance = 0.0f;
  return display_stops(render_reference(world, camera, settings).image);
}

/// The exposure for a sequence, of whose frames these are suited by these; none where it is about
/// that of the first one.
std::optional<float> common_exposure(std::vector<float> stops) {
  if (stops.empty()) return std::nullopt;
  const float first = stops.front();
  const auto middle = stops.begin() + static_cast<std::ptrdiff_t>(stops.size() / 2);
  std::nth_element(stops.begin(), middle, stops.end());
  if (std::abs(*middle - first) < kMinDifference) return std::nullopt;
  return *middle;
}

}  // namespace

double time_of_frame(const RenderOptions& options, double frame) {
  return static_cast<double>(options.time_s.value_or(0.0f)) +
         frame / static_cast<double>(options.fps);
}

Expected<WorldChanges> pose_at(const PosedScene& posed, double time_s) {
  animate(posed.scene, posed.animation, static_cast<float>(time_s));
  if (posed.first_sky) adjust_first_sky(posed.scene);
  return posed.world.update();
}

Expected<Camera> camera_of_pose(const RenderOptions& options, const View& first,
                                const Scene& scene) {
  if (first.from != View::From::scene || scene.animations.empty()) return first.camera;
  return camera_of_scene(options.scene, scene);
}

Expected<SequenceSurvey> survey_sequence(const RenderOptions& options, const PosedScene& posed,
                                         const View& view) {
  SequenceSurvey survey;
  if (posed.scene.animations.empty()) return survey;
  begin_step("looking at the sequence");
  const std::optional<FieldGrid> grid =
      uses_field(options) ? refinable_grid(options, posed.world, view.camera) : std::nullopt;
  const bool exposes = chooses_exposure(options);
  // Paths are traced on the processor
  std::optional<World> host;
  if (exposes && posed.world.device() != nullptr) host.emplace(posed.scene);
  const int places = std::min(options.frames, kSurveyed);
  bool moves = false;
  std::vector<float> stops(exposes ? places : 0);
  // The first frame comes last, and stays
  for (int place = places - 1; place >= 0; --place) {
    const double frame = place * (options.frames - 1.0) / std::max(places - 1, 1);
    const auto changes = pose_at(posed, time_of_frame(options, frame));
    if (!changes) return tl::unexpected(changes.error());
    const Expected<Camera> camera = camera_of_pose(options, view, posed.scene);
    if (!camera) return tl::unexpected(camera.error());
    moves = moves || camera->world_from_view[3] != view.camera.world_from_view[3];
    if (const auto box = grid ? near_box(posed.world, *camera, *grid) : std::nullopt) {
      survey.path_boxes.push_back(*box);
    }
    if (!exposes) continue;
    if (host) {
      if (const auto same = host->update(); !same) return tl::unexpected(same.error());
    }
    stops[place] = exposure_of_pose(host ? *host : posed.world, *camera, options);
  }
  if (!moves) survey.path_boxes.clear();
  survey.stops = common_exposure(std::move(stops));
  return survey;
}

}  // namespace lambent::cli
