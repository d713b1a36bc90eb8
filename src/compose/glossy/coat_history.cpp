// SPDX-License-Identifier: Apache-2.0
#include "compose/glossy/coat_history.h"

#include <algorithm>

#include "compose/frame_tasks.h"
#include "core/parallel.h"
#include "denoise/atrous_pass.h"
#include "lambent/denoise.h"

namespace lambent {
namespace {

/// The surfaces of the previous frame, as history.inl.h reads them.
struct SurfacesBefore {
  float fetch_depth_before(int pixel) const { return seen.depths[pixel]; }
  vec3 fetch_normal_before(int pixel) const { return seen.geometric_normals_ws[pixel]; }

#include "denoise/history.inl.h"

  const SurfacesSeen& seen;
};

/// lobe_weight.inl.h for one pixel.
struct LobeWeights {
  using Real = float;
  using Real3 = vec3;
  static float larger(float a, float b) { return std::max(a, b); }

#define LAMBENT_REAL_FN static inline
#include "denoise/lobe_weight.inl.h"
#undef LAMBENT_REAL_FN

  static PixelLobe of(const LobeOfPixel& lobe) {
    return {lobe.mirror_ws, lobe.sharpness, lobe.inverse_distance};
  }
};

/// Pixels of the previous frame that show what a pixel's lobe shows, and their weights, whose sum
/// is the share of the history that counts.
struct LobeTaps {
  HistoryTaps taps = no_history();
  float share = 0.0f;
};

/// Finds the history of a frame's lobes.
class LobeFinder {
 public:
  LobeFinder(const FrameAveraging& by, const SurfacesSeen& now, const SurfacesSeen& before,
             const LobeHistory& last)
      : by_(by), now_(now), before_(before), surfaces_{before_}, last_(last) {
    const float lobe_share = geometric_denoising().lobe_share;
    lobe_scale_ = 1.0f / (lobe_share * lobe_share);
  }

  LobeTaps find(std::size_t pixel, const PixelMotion& motion, const vec3& to_viewer_ws,
                const LobeGuide& guide) {
    const ivec2 at(static_cast<int>(pixel) % by_.size.x, static_cast<int>(pixel) / by_.size.x);
    const vec2 place = vec2(at) + vec2(0.5f) + motion.offset;
    const Pixel here{pixel, to_viewer_ws, guide, motion.offset == vec2(0.0f)};
    const LobeTaps on_surface = taps_at(here, place, motion.depth_before);
    if (on_surface.share >= 1.0f || guide.inverse_distance <= 0.0f) return on_surface;
    const LobeTaps in_mirror = taps_of_image(here);
    return in_mirror.share > on_surface.share ? in_mirror : on_surface;
  }

 private:
  struct Pixel {
    std::size_t index;
    vec3 to_viewer_ws;
    const LobeGuide& guide;
    bool rests;  // its surface is at the same place as in the previous frame
  };

  /// History where the previous camera saw, in the plane of a pixel's surface, what its lobe shows.
  LobeTaps taps_of_image(const Pixel& here) {
    const vec3& position_ws = now_.positions_ws[here.index];
    const vec3& normal_ws = now_.geometric_normals_ws[here.index];
    const vec3 image_ws = position_ws - here.to_viewer_ws / here.guide.inverse_distance;
    const ImagePoint seen = image_point(by_.views.before, image_ws);
    if (!(seen.depth > 0.0f)) return {};
    const CameraRay ray = camera_ray(by_.views.before, seen.pixel);
    const float along =
        dot(position_ws - ray.origin_ws, normal_ws) / dot(ray.direction_ws, normal_ws);
    const float depth = view_depth(by_.views.before, ray.origin_ws + along * ray.direction_ws);
    if (!(depth > 0.0f && depth < infinity())) return {};
    return taps_at(here, seen.pixel, depth);
  }

  /// History around a place of the previous frame at which a surface has this depth.
  LobeTaps taps_at(const Pixel& here, vec2 place, float depth) {
    const vec3& normal_ws = now_.geometric_normals_ws[here.index];
    const float width = pixel_width_at_depth(by_.views.now, depth);
    LobeTaps found;
    found.taps = surfaces_.history_taps(
        by_.size, place, depth, depth_tolerance(depth, width, dot(normal_ws, here.to_viewer_ws)),
        normal_ws);
    for (int k = 0; k < 4; ++k) {
      float& weight = found.taps.weights[k];
      if (weight > 0.0f) weight *= agreement(here, static_cast<std::size_t>(found.taps.pixels[k]));
      found.share += weight;
    }
    return found;
  }

  /// How far a previous pixel's lobe shows what a pixel's lobe shows, 0 to 1.
  float agreement(const Pixel& here, std::size_t tap) const {
    const LobeOfPixel& there = last_.lobes[tap];
    if (there.sharpness <= 0.0f) return 0.0f;
    const LobeGuide& guide = here.guide;
    const LobeWeights::PixelLobe lobe{guide.mirror_ws, guide.sharpness, guide.inverse_distance};
    LobeWeights::PixelLobe lobe_there = LobeWeights::of(there);
    vec3 apart_ws = before_.positions_ws[tap] - now_.positions_ws[here.index];
    if (here.rests) {
      // Directions differ by the jitter within the pixel, over which mirrors are averaged, too
      lobe_there.mirror_ws = lobe.mirror_ws;
      apart_ws = vec3(0.0f);
    }
    return LobeWeights::falloff(
        LobeWeights::difference_of_lobes(lobe_scale_, lobe, lobe_there, apart_ws, guide.across_ws));
  }

  const FrameAveraging& by_;
  const SurfacesSeen& now_;
  const SurfacesSeen& before_;
  SurfacesBefore surfaces_;
  const LobeHistory& last_;
  float lobe_scale_;
};

/// Averages light with the weighted mean of the history's.
void average(const std::vector<vec3>& before, const LobeTaps& found, float frames, vec3& light) {
  light = finite_or_dark(light);
  if (frames <= 1.0f) return;
  vec3 sum(0.0f);
  for (int k = 0; k < 4; ++k) {
    if (found.taps.weights[k] > 0.0f) {
      sum += found.taps.weights[k] * before[static_cast<std::size_t>(found.taps.pixels[k])];
    }
  }
  light = mix(sum / found.share, light, 1.0f / frames);
}

float mean_frames(const std::vector<float>& frames, const LobeTaps& found) {
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) {
    sum += found.taps.weights[k] * frames[static_cast<std::size_t>(found.taps.pixels[k])];
  }
  return sum;
}

}  // namespace

void average_lobes(const FrameAveraging& by, std::span<const PixelMotion> motion,
                   const SurfacesSeen& now, const SurfacesSeen& before, const LobeHistory& last,
                   const LobesSeen& lobes, LobeHistory& next) {
  const std::size_t pixels = lobes.light.size();
  const bool has_history = !before.depths.empty() && last.light.size() == pixels &&
                           last.excess.size() == lobes.excess.size();
  next.lobes.resize(pixels);
  next.light.resize(pixels);
  next.excess.resize(lobes.excess.size());
  next.frames.resize(pixels);
  parallel_chunks(pixels, kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    LobeFinder finder(by, now, before, last);
    for (std::size_t i = begin; i < end; ++i) {
      next.lobes[i] = {};
      next.frames[i] = 0.0f;
      if (lobes.alphas[i] <= 0.0f) continue;
      const LobeGuide guide = lobe_guide(lobes.normals_ws[i], lobes.to_viewer_ws[i],
                                         lobes.alphas[i], lobes.inverse_distances[i]);
      LobeTaps found;
      if (has_history && motion[i].known != 0u) {
        found = finder.find(i, motion[i], lobes.to_viewer_ws[i], guide);
      }
      const float frames = found.share > 0.0f
                               ? averaged_frames(mean_frames(last.frames, found), by.most_frames)
                               : 1.0f;
      average(last.light, found, frames, lobes.light[i]);
      if (!lobes.excess.empty()) average(last.excess, found, frames, lobes.excess[i]);
      next.lobes[i] = {guide.mirror_ws, guide.sharpness, guide.inverse_distance};
      next.light[i] = lobes.light[i];
      if (!lobes.excess.empty()) next.excess[i] = lobes.excess[i];
      next.frames[i] = frames;
    }
  });
}

}  // namespace lambent
