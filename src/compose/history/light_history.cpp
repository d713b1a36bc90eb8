// SPDX-License-Identifier: Apache-2.0
#include "compose/history/light_history.h"

#include <optional>

#include "compose/frame_tasks.h"
#include "compose/history/lookup_levels.h"
#include "compose/motion/motion.h"
#include "core/parallel.h"
#include "denoise/history_math.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

/// The largest numbers of frames over which light of a pixel may be averaged.
struct MostFrames {
  float of_emitters, of_gathers;
};

// Number of frames after the last change of the world that still show lookups averaged. Without
// them, pictures of a world that changes in every second frame would go to and fro between averages
// and single lookups. After so many, the averages hold lookups in the world as it is.
constexpr int kFramesAfterChange = 8;

/// Averages one kind of light of a pixel with the history's.
void average(const vec3& before, float frames, vec3& now) {
  if (frames > 1.0f) now = mix(before, now, 1.0f / frames);
}

/// The light of previous frames at a pixel.
struct PixelHistory {
  std::size_t pixel;
  const HistoryTaps& taps;
  /// How its gathered light follows the lookups around; empty: those of the pixel alone tell.
  std::optional<FollowedLevel> level;
};

/// How a pixel's gathered light is averaged.
struct GatherAverage {
  MostFrames most;
  bool shows_lookups;  ///< Lookups, too, are shown averaged.
  bool relit;          ///< Lights, materials or the sky have changed: excess starts anew.
  bool moves;          ///< The pixel shows what moves.
};

/// Averages what a pixel gathers, over fewer frames where lookups have changed: those around it
/// while light moves, else its own. Excess is averaged over many frames. That of what moves is
/// shown as it is: where the field lags behind it, most rays bring more than their lookups.
void average_gathered(const LightHistory& last, const PixelHistory& history,
                      const GatherAverage& by, FilteredPixels& pixels, LightHistory& next) {
  const std::size_t i = history.pixel;
  const HistoryTaps& taps = history.taps;
  vec3& difference = next.differences[i] = pixels.gathered[i] - pixels.looked_up[i];
  vec3& looked_up = next.looked_up[i] = pixels.looked_up[i];
  float& frames = next.gathered_frames[i] = 1.0f;
  const vec3 factor = history.level ? history.level->factor : vec3(1.0f);
  const vec3 looked_up_before = factor * weighted_sum(last.looked_up, taps);
  if (is_history(taps)) {
    // While light moves, single lookups have much noise: where averages ended by them, there were
    // stains with edges
    const float kept = history.level
                           ? history.level->kept
                           : kept_by_lookup(luminance(looked_up_before), luminance(looked_up));
    frames = averaged_frames(kept * weighted_sum(last.gathered_frames, taps), by.most.of_gathers);
  }
  const vec3 difference_before = factor * weighted_sum(last.differences, taps);
  const float off = luminance(difference - difference_before);
  average(difference_before, frames, difference);
  average(looked_up_before, frames, looked_up);
  const vec3 excess = by.relit ? vec3(0.0f) : weighted_sum(last.excess, taps);
  next.excess[i] = averaged_excess(excess, pixels.excess[i]);
  if (!by.moves) pixels.excess[i] = next.excess[i];
  if (by.shows_lookups) pixels.looked_up[i] = looked_up;
  pixels.gathered[i] = pixels.looked_up[i] + difference;
  average_noise(last.gathered_noise, {i, taps, off, frames, by.relit},
                {pixels.gathered_variance, pixels.gathered_history_variance}, next.gathered_noise);
}

void average_emitters(const LightHistory& last, const HistoryTaps& taps, const MostFrames& most,
                      bool relit, std::size_t i, FilteredPixels& pixels, LightHistory& next) {
  vec3& light = pixels.emitters[i];
  float& frames = next.frames[i] = 1.0f;
  if (is_history(taps)) {
    frames = averaged_frames(weighted_sum(last.frames, taps), most.of_emitters);
  }
  const vec3 before = weighted_sum(last.emitters, taps);
  const float off = luminance(light - before);
  average(before, frames, light);
  next.emitters[i] = light;
  average_noise(last.emitter_noise, {i, taps, off, frames, relit},
                {pixels.emitter_variance, pixels.emitter_history_variance}, next.emitter_noise);
}

MostFrames most_frames(const FrameAveraging& by, const ChangedLight* changed,
                       const FilteredPixels& pixels, std::size_t i) {
  MostFrames most{by.most_frames, by.most_frames};
  if (changed == nullptr) return most;
  const vec3 &position_ws = pixels.positions_ws[i], &normal_ws = pixels.geometric_normals_ws[i];
  most.of_emitters =
      std::min(most.of_emitters, changed->frames_of_emitters(position_ws, normal_ws));
  most.of_gathers =
      std::min(most.of_gathers, changed->moved.frames_of_gathers(position_ws, normal_ws));
  return most;
}

void shape(const FilteredPixels& pixels, LightHistory& history) {
  history.positions_ws = pixels.positions_ws;
  history.normals_ws = pixels.geometric_normals_ws;
  history.depths = pixels.depths;
  history.differences.resize(pixels.gathered.size());
  history.looked_up.resize(pixels.gathered.size());
  history.gathered_frames.resize(pixels.gathered.size());
  history.excess.resize(pixels.excess.size());
  history.emitters.resize(pixels.emitters.size());
  history.gathered_noise.resize(pixels.gathered.size(), !pixels.gathered_variance.empty());
  history.emitter_noise.resize(pixels.emitters.size(), !pixels.emitter_variance.empty());
  history.frames.resize(pixels.depths.size());
}

/// Whether a history holds the kinds of light that are to be averaged.
bool has_same_light(const LightHistory& last, const FilteredPixels& pixels) {
  return last.is_there && last.depths.size() == pixels.depths.size() &&
         last.differences.size() == pixels.gathered.size() &&
         last.excess.size() == pixels.excess.size() &&
         last.emitters.size() == pixels.emitters.size() &&
         last.gathered_noise.measured.size() == pixels.gathered_variance.size() &&
         last.emitter_noise.measured.size() == pixels.emitter_variance.size();
}

/// The surfaces of the previous frame; empty where its light does not continue.
SurfacesSeen surfaces_before(const LightHistory& last, bool continues) {
  if (!continues) return {};
  return {last.positions_ws, last.normals_ws, last.depths};
}

/// Averages the light that coats and clearcoats reflect, and the highlights of emitters.
void average_reflections(const FrameAveraging& by, const LightHistory& last, bool continues,
                         FilteredPixels& pixels, LightHistory& next) {
  const SurfacesSeen now{pixels.positions_ws, pixels.geometric_normals_ws, pixels.depths};
  const SurfacesSeen before = surfaces_before(last, continues);
  const auto average_lobes = [&](const LobesSeen& lobes, const LobeHistory& history,
                                 LobeHistory& kept) {
    average_reflected_light(by, now, before, history, lobes, kept);
  };
  FilteredCoats &coats = pixels.coats, &clearcoats = pixels.clearcoats;
  average_lobes({pixels.normals_ws, pixels.to_viewer_ws, coats.alphas, coats.inverse_distances,
                 coats.light, coats.excess, coats.variance},
                last.coats, next.coats);
  average_lobes(
      {clearcoats.normals_ws, pixels.to_viewer_ws, clearcoats.alphas, clearcoats.inverse_distances,
       clearcoats.light, clearcoats.excess, clearcoats.variance},
      last.clearcoats, next.clearcoats);
  average_lobes({pixels.normals_ws,
                 pixels.to_viewer_ws,
                 pixels.highlight_alphas,
                 pixels.highlight_inverse_distances,
                 pixels.highlights,
                 {},
                 {}},
                last.highlights, next.highlights);
}

/// Finds the pixels of the previous frame that show a pixel's surface.
struct PixelFinder {
  const FrameAveraging& by;
  const FilteredPixels& pixels;
  SurfacesSeen before;  ///< Empty: there is no previous frame.

  HistoryTaps taps(std::size_t i) const {
    if (before.depths.empty() || !(pixels.depths[i] > 0.0f)) return no_history();
    const PixelMotion motion = camera_motion(by.views, pixels.positions_ws[i]);
    if (motion.known == 0u) return no_history();
    const float depth = motion.depth_before;
    return SurfacesBefore{before}.history_taps(by.size, middle_of(i, by.size) + motion.offset,
                                               depth, tolerance(i, depth),
                                               pixels.geometric_normals_ws[i]);
  }
  /// Tolerance of the depth of a pixel's surface, `depth` away, between places that are `apart`
  /// pixels apart [m].
  float tolerance(std::size_t i, float depth, int apart = 1) const {
    const CameraRecord& camera = by.views.now;
    const bool parallel = camera.orthographic != 0u;
    const vec3 to_viewer =
        normalize(parallel ? camera.axes[2] : camera.position_ws - pixels.positions_ws[i]);
    const float width = static_cast<float>(apart) * pixel_width_at_depth(camera, depth);
    return depth_tolerance(depth, width, dot(pixels.geometric_normals_ws[i], to_viewer));
  }
};

DenoiseView view_of(const FrameAveraging& by, const FilteredPixels& pixels) {
  return {.width = by.size.x,
          .height = by.size.y,
          .positions_ws = pixels.positions_ws,
          .normals_ws = pixels.geometric_normals_ws,
          .depths = pixels.depths};
}

/// Finds how the level of lookups has changed since the previous frames.
LookupLevels levels_since(const LightHistory& last, const PixelFinder& finder) {
  const FilteredPixels& pixels = finder.pixels;
  std::vector<vec3> before(pixels.looked_up.size());
  std::vector<float> depths(before.size());
  parallel_chunks(before.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HistoryTaps taps = finder.taps(i);
      if (!is_history(taps)) continue;
      before[i] = weighted_sum(last.looked_up, taps);
      depths[i] = pixels.depths[i];
    }
  });
  DenoiseView view = view_of(finder.by, pixels);
  view.depths = depths;
  return {view, before, pixels.looked_up};
}

}  // namespace

void average_light(const FrameRequest& request, const LightHistory& last, FilteredPixels& pixels,
                   LightHistory& next) {
  const FrameSettings& settings = request.settings;
  const ChangedLight* changed = request.changed;
  const FrameAveraging by{
      {settings.width, settings.height},
      motion_views(request.camera, settings.width, settings.height, request.before),
      static_cast<float>(settings.averaged_frames),
      changed != nullptr ? &changed->moved : nullptr};
  const bool relit = changed != nullptr && changed->relit;
  const bool continues =
      (request.light_continues || changed != nullptr) && has_same_light(last, pixels);
  shape(pixels, next);
  // Once the world is lit otherwise, most averages begin anew, and neighbours give a better
  // estimate of the noise of a few frames
  const bool has_noise = continues && !relit;
  pixels.gathered_history_variance.resize(has_noise ? next.gathered_noise.shares.size() : 0);
  pixels.emitter_history_variance.resize(has_noise ? next.emitter_noise.shares.size() : 0);
  const PixelFinder finder{by, pixels, surfaces_before(last, continues)};
  const bool gathers = !pixels.gathered.empty();
  next.averaged_lookups =
      changed != nullptr ? kFramesAfterChange : std::max(last.averaged_lookups - 1, 0);
  const bool shows_lookups =
      continues && gathers && (changed != nullptr || last.averaged_lookups > 0);
  LookupLevels levels;
  if (shows_lookups) levels = levels_since(last, finder);
  const DenoiseView view = view_of(by, pixels);
  parallel_chunks(pixels.depths.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HistoryTaps taps = finder.taps(i);
      const MostFrames most = most_frames(by, changed, pixels, i);
      if (gathers) {
        const bool moves = by.moved != nullptr && by.moved->contain(pixels.positions_ws[i]);
        std::optional<FollowedLevel> level;
        if (shows_lookups) {
          const float tolerance = finder.tolerance(i, pixels.depths[i], levels.pixels_apart());
          level = levels.followed(view, i, tolerance);
        }
        average_gathered(last, {i, taps, level}, {most, shows_lookups, relit, moves}, pixels, next);
      }
      if (!pixels.emitters.empty()) average_emitters(last, taps, most, relit, i, pixels, next);
    }
  });
  average_reflections(by, last, continues && !relit, pixels, next);
  next.is_there = true;
}

}  // namespace lambent
