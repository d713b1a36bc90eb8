// SPDX-License-Identifier: Apache-2.0
#include "lambent/sequence_survey.h"

#include <algorithm>
#include <cmath>

#include "core/image/exposure.h"
#include "lambent/animation.h"
#include "lambent/first_picture.h"
#include "lambent/frame_renderer.h"
#include "lambent/output.h"
#include "lambent/parse.h"
#include "lambent/quality.h"
#include "lambent/step.h"
#include "reference/path_tracer.h"

namespace lambent::cli {
namespace {

// Number of frames that are looked at, the first and the last among them: enough to tell of most of
// a sequence, and few beside the frames of one that takes long.
constexpr int kSurveyed = 9;
// Longer side of the pictures from which exposures are found [pixels], and paths a pixel. Noise
// makes the mean of logarithms too dark: in a room lit through a door by 0.1 stops, with twice the
// side and a quarter of the paths by 0.3.
constexpr int kExposedSide = 32, kExposedSamples = 256;
// An exposure that differs by less from the first frame's is no reason to leave that one [stops]:
// what is twice as bright as it should be still shows.
constexpr float kMinDifference = 1.0f;

/// The frame at one of some places that are spread evenly over a sequence; between frames, too.
double surveyed_frame(const RenderOptions& options, int place, int places) {
  return place * (options.frames - 1.0) / std::max(places - 1, 1);
}

/// Whether the program chooses the exposure of the sequence.
bool chooses_exposure(const RenderOptions& options) {
  const auto asked = parse_exposure(options.exposure);
  return asked && !*asked && !has_ending(options.output, ".exr");
}

/// The exposure that suits a pose [stops]; none where it is black.
std::optional<float> exposure_of_pose(const World& world, const Camera& camera,
                                      const RenderOptions& options, const glm::ivec2& size) {
  const glm::ivec2 preview = preview_of(size, kExposedSide);
  ReferenceSettings settings;
  settings.width = preview.x;
  settings.height = preview.y;
  settings.samples = kExposedSamples;
  settings.unlit_radiance = 0.0f;
  if (options.method == "direct") settings.max_bounces = 0;
  const ReferenceResult seen = render_reference(world, camera, settings);
  const std::vector<float>& radiance = seen.image.find("")->pixels;
  if (std::ranges::all_of(radiance, [](float v) { return v == 0.0f; })) return std::nullopt;
  return display_stops(seen.image);
}

/// The median of the exposures that suit some frames of a sequence; none where it is about that of
/// the first frame, which has none where it is black.
std::optional<float> common_exposure(std::vector<float> stops, const std::optional<float>& first) {
  if (stops.empty()) return std::nullopt;
  std::ranges::sort(stops);
  const float median = 0.5f * (stops[(stops.size() - 1) / 2] + stops[stops.size() / 2]);
  if (first && std::abs(median - *first) < kMinDifference) return std::nullopt;
  return median;
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

Poses poses_of_sequence(const RenderOptions& options, const PosedScene& posed) {
  if (options.frames == 0 || posed.scene.animations.empty()) return {};
  const int places = std::min(options.frames, kSurveyed);
  return {places, [&options, &posed, places](int place) -> Expected<void> {
            const double frame = surveyed_frame(options, place, places);
            const auto changes = pose_at(posed, time_of_frame(options, frame));
            if (!changes) return tl::unexpected(changes.error());
            return {};
          }};
}

Expected<Camera> camera_of_pose(const RenderOptions& options, const View& first,
                                const Scene& scene) {
  if (first.from != View::From::scene || scene.animations.empty()) return first.camera;
  return camera_of_scene(options.scene, scene);
}

Expected<FirstLight> choose_light_of_sequence(const RenderOptions& options, const PosedScene& posed,
                                              const View& view) {
  FirstLight light = choose_first_light(posed.world, view.camera);
  // FirstLight::sky is for scenes with suns
  const bool may_need_sky = light == FirstLight::scene && !posed.scene.lights.empty();
  if (!may_need_sky || posed.scene.animations.empty()) return light;
  begin_step("looking for the sky");
  const int places = std::min(options.frames, kSurveyed);
  // The first frame comes last, and stays
  for (int place = places - 1; place >= 0; --place) {
    const auto changes =
        pose_at(posed, time_of_frame(options, surveyed_frame(options, place, places)));
    if (!changes) return tl::unexpected(changes.error());
    const Expected<Camera> camera = camera_of_pose(options, view, posed.scene);
    if (camera && choose_first_light(posed.world, *camera) == FirstLight::sky) {
      light = FirstLight::sky;
      place = std::min(place, 1);
    }
  }
  return light;
}

Expected<SequenceSurvey> survey_sequence(const RenderOptions& options, const PosedScene& posed,
                                         const View& view, const glm::ivec2& size,
                                         const InterruptGuard& guard) {
  SequenceSurvey survey;
  if (posed.scene.animations.empty()) return survey;
  begin_step("looking at the sequence");
  const std::optional<FieldGrid> grid =
      uses_field(options) ? refinable_grid(options, posed.world, view.camera) : std::nullopt;
  const bool exposes = chooses_exposure(options);
  if (!grid && !exposes) return survey;
  // Paths are traced on the processor
  std::optional<World> host;
  if (exposes && posed.world.device() != nullptr) host.emplace(posed.scene);
  const int places = std::min(options.frames, kSurveyed);
  bool moves = false;
  std::vector<float> stops;
  std::optional<float> suits;
  // The first frame comes last, and stays
  for (int place = places - 1; place >= 0; --place) {
    if (guard.interrupted()) place = 0;
    const double frame = surveyed_frame(options, place, places);
    const auto changes = pose_at(posed, time_of_frame(options, frame));
    if (!changes) return tl::unexpected(changes.error());
    const Expected<Camera> camera = camera_of_pose(options, view, posed.scene);
    if (!camera) continue;  // the frame will say why
    moves = moves || camera->world_from_view[3] != view.camera.world_from_view[3];
    if (const auto box = grid ? near_box(posed.world, *camera, *grid) : std::nullopt) {
      survey.path_boxes.push_back(*box);
    }
    if (!exposes) continue;
    if (host) {
      if (const auto same = host->update(); !same) return tl::unexpected(same.error());
    }
    suits = exposure_of_pose(host ? *host : posed.world, *camera, options, size);
    if (suits) stops.push_back(*suits);
  }
  if (!moves) survey.path_boxes.clear();
  std::ranges::reverse(survey.path_boxes);
  survey.stops = common_exposure(std::move(stops), suits);
  return survey;
}

}  // namespace lambent::cli
