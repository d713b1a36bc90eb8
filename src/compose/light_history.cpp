// SPDX-License-Identifier: Apache-2.0
#include "compose/light_history.h"

#include "compose/frame_tasks.h"
#include "compose/motion.h"
#include "core/parallel.h"
#include "denoise/history_math.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

/// The previous frame, as history.inl.h reads it.
struct FrameOfHistory {
  explicit FrameOfHistory(const LightHistory& last) : history(last) {}
  float fetch_depth_before(int pixel) const {
    return history.depths[static_cast<std::size_t>(pixel)];
  }
  vec3 fetch_normal_before(int pixel) const {
    return history.normals_ws[static_cast<std::size_t>(pixel)];
  }

#include "denoise/history.inl.h"

  const LightHistory& history;
};

/// Weighted mean of a value over the taps.
template <class T>
T mean_of(const std::vector<T>& values, const HistoryTaps& taps) {
  T sum(0.0f);
  for (int k = 0; k < 4; ++k) {
    if (taps.weights[k] > 0.0f) {
      sum += taps.weights[k] * values[static_cast<std::size_t>(taps.pixels[k])];
    }
  }
  return sum;
}

/// Averages one kind of light of a pixel with the history's.
template <class T>
void average(const std::vector<T>& before, const HistoryTaps& taps, float frames, T& now) {
  if (frames > 1.0f) now = mix(mean_of(before, taps), now, 1.0f / frames);
}
void average_variance(const std::vector<float>& before, const HistoryTaps& taps, float frames,
                      float& now) {
  if (frames > 1.0f) now = averaged_variance(mean_of(before, taps), now, frames);
}

void shape(const FilteredPixels& pixels, LightHistory& history) {
  history.positions_ws = pixels.positions_ws;
  history.normals_ws = pixels.geometric_normals_ws;
  history.depths = pixels.depths;
  history.differences.resize(pixels.gathered.size());
  history.excess.resize(pixels.excess.size());
  history.emitters.resize(pixels.emitters.size());
  history.gathered_variance.resize(pixels.gathered_variance.size());
  history.emitter_variance.resize(pixels.emitter_variance.size());
  history.frames.resize(pixels.depths.size());
}

/// Whether a history holds the kinds of light that are to be averaged.
bool has_same_light(const LightHistory& last, const FilteredPixels& pixels) {
  return last.is_there && last.depths.size() == pixels.depths.size() &&
         last.differences.size() == pixels.gathered.size() &&
         last.excess.size() == pixels.excess.size() &&
         last.emitters.size() == pixels.emitters.size() &&
         last.gathered_variance.size() == pixels.gathered_variance.size() &&
         last.emitter_variance.size() == pixels.emitter_variance.size();
}

/// Averages the light that coats and clearcoats reflect, and the highlights of emitters.
void average_reflections(const FrameRequest& request, std::span<const PixelMotion> motion,
                         const LightHistory& last, bool continues, FilteredPixels& pixels,
                         LightHistory& next) {
  const FrameSettings& settings = request.settings;
  const FrameAveraging by{
      {settings.width, settings.height},
      motion_views(request.camera, settings.width, settings.height, request.before),
      static_cast<float>(settings.averaged_frames)};
  const SurfacesSeen now{pixels.positions_ws, pixels.geometric_normals_ws, pixels.depths};
  SurfacesSeen before;
  if (continues) before = {last.positions_ws, last.normals_ws, last.depths};
  FilteredCoats &coats = pixels.coats, &clearcoats = pixels.clearcoats;
  average_lobes(by, motion, now, before, last.coats,
                {pixels.normals_ws, pixels.to_viewer_ws, coats.alphas, coats.inverse_distances,
                 coats.light, coats.excess},
                next.coats);
  average_lobes(by, motion, now, before, last.clearcoats,
                {clearcoats.normals_ws, pixels.to_viewer_ws, clearcoats.alphas,
                 clearcoats.inverse_distances, clearcoats.light, clearcoats.excess},
                next.clearcoats);
  average_lobes(by, motion, now, before, last.highlights,
                {pixels.normals_ws,
                 pixels.to_viewer_ws,
                 pixels.highlight_alphas,
                 pixels.highlight_inverse_distances,
                 pixels.highlights,
                 {}},
                next.highlights);
}

}  // namespace

void average_light(const FrameRequest& request, std::span<const PixelMotion> motion,
                   const LightHistory& last, FilteredPixels& pixels, LightHistory& next) {
  const FrameSettings& settings = request.settings;
  const ivec2 size(settings.width, settings.height);
  const auto most = static_cast<float>(settings.averaged_frames);
  const bool continues = request.light_continues && has_same_light(last, pixels);
  const CameraRecord camera = camera_record(request.camera, settings.width, settings.height);
  shape(pixels, next);
  parallel_chunks(pixels.depths.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    FrameOfHistory before(last);
    for (std::size_t i = begin; i < end; ++i) {
      HistoryTaps taps = no_history();
      if (continues && pixels.depths[i] > 0.0f && motion[i].known != 0u) {
        const vec3 normal_ws = pixels.geometric_normals_ws[i];
        const bool parallel = camera.orthographic != 0u;
        const vec3 to_viewer =
            normalize(parallel ? camera.axes[2] : camera.position_ws - pixels.positions_ws[i]);
        const vec2 place(static_cast<float>(i % static_cast<std::size_t>(size.x)) + 0.5f,
                         static_cast<float>(i / static_cast<std::size_t>(size.x)) + 0.5f);
        const float depth = motion[i].depth_before;
        taps = before.history_taps(
            size, place + motion[i].offset, depth,
            depth_tolerance(depth, pixel_width_at_depth(camera, depth), dot(normal_ws, to_viewer)),
            normal_ws);
      }
      const bool seen_before = is_history(taps);
      const float frames = seen_before ? averaged_frames(mean_of(last.frames, taps), most) : 1.0f;
      next.frames[i] = frames;
      if (!pixels.gathered.empty()) {
        vec3 difference = pixels.gathered[i] - pixels.looked_up[i];
        average(last.differences, taps, frames, difference);
        average(last.excess, taps, frames, pixels.excess[i]);
        next.differences[i] = difference;
        next.excess[i] = pixels.excess[i];
        pixels.gathered[i] = pixels.looked_up[i] + difference;
      }
      if (!pixels.gathered_variance.empty()) {
        average_variance(last.gathered_variance, taps, frames, pixels.gathered_variance[i]);
        next.gathered_variance[i] = pixels.gathered_variance[i];
      }
      if (!pixels.emitters.empty()) {
        average(last.emitters, taps, frames, pixels.emitters[i]);
        next.emitters[i] = pixels.emitters[i];
      }
      if (!pixels.emitter_variance.empty()) {
        average_variance(last.emitter_variance, taps, frames, pixels.emitter_variance[i]);
        next.emitter_variance[i] = pixels.emitter_variance[i];
      }
    }
  });
  average_reflections(request, motion, last, continues, pixels, next);
  next.is_there = true;
}

}  // namespace lambent
