// SPDX-License-Identifier: Apache-2.0
#include "compose/history/lobe_history.h"

#include <algorithm>

#include "compose/frame_tasks.h"
#include "core/parallel.h"
#include "lambent/denoise.h"

namespace lambent {
namespace {

/// lobe_weight.inl.h for one pixel.
struct LobeWeights {
  using Real = float;
  using Real3 = vec3;
  static float larger(float a, float b) { return std::max(a, b); }

#define LAMBENT_REAL_FN static inline
#include "denoise/lobe_weight.inl.h"
#undef LAMBENT_REAL_FN

  static PixelLobe of(const LobeGuide& guide) {
    return {guide.mirror_ws, guide.sharpness, guide.inverse_distance};
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
      : by_(by), now_(now), before_{before}, last_(last) {
    const float lobe_share = geometric_denoising().lobe_share;
    lobe_scale_ = 1.0f / (lobe_share * lobe_share);
  }

  LobeTaps find(std::size_t pixel, const vec3& to_viewer_ws, const LobeGuide& guide) {
    const PixelMotion motion = camera_motion(by_.views, now_.positions_ws[pixel]);
    if (motion.known == 0u) return {};
    const Pixel here{pixel, to_viewer_ws, guide, motion.offset == vec2(0.0f)};
    const LobeTaps on_surface =
        taps_at(here, middle_of(pixel, by_.size) + motion.offset, motion.depth_before);
    if (here.rests || on_surface.share >= 1.0f) return on_surface;
    const LobeTaps in_mirror = taps_of_image(here);
    return in_mirror.share > on_surface.share ? in_mirror : on_surface;
  }

 private:
  struct Pixel {
    std::size_t index;
    vec3 to_viewer_ws;
    const LobeGuide& guide;
    bool rests;  // the previous camera saw its surface at the same place: its only tap is itself
  };

  /// History where the previous camera saw, in the plane of a pixel's surface, what its lobe shows.
  LobeTaps taps_of_image(const Pixel& here) {
    const CameraRecord& view = by_.views.before;
    const vec3& position_ws = now_.positions_ws[here.index];
    const vec3& normal_ws = now_.geometric_normals_ws[here.index];
    const float inverse_distance = here.guide.inverse_distance;
    const ImagePoint seen =
        inverse_distance > 0.0f
            ? image_point(view, position_ws - here.to_viewer_ws / inverse_distance)
            : image_point_of_sky(view, -here.to_viewer_ws);
    if (!(seen.depth > 0.0f) || !is_in_picture(seen.pixel)) return {};
    const CameraRay ray = camera_ray(view, seen.pixel);
    const float along =
        dot(position_ws - ray.origin_ws, normal_ws) / dot(ray.direction_ws, normal_ws);
    const float depth = view_depth(view, ray.origin_ws + along * ray.direction_ws);
    if (!(depth > 0.0f && depth < infinity())) return {};
    return taps_at(here, seen.pixel, depth);
  }

  bool is_in_picture(vec2 place) const {
    return place.x >= 0.0f && place.y >= 0.0f && place.x <= static_cast<float>(by_.size.x) &&
           place.y <= static_cast<float>(by_.size.y);
  }

  /// History around a place of the previous frame at which a surface has this depth.
  LobeTaps taps_at(const Pixel& here, vec2 place, float depth) {
    const vec3& normal_ws = now_.geometric_normals_ws[here.index];
    const float width = pixel_width_at_depth(by_.views.before, depth);
    LobeTaps found;
    found.taps = before_.history_taps(
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
    const LobeGuide& there = last_.lobes[tap];
    if (there.sharpness <= 0.0f) return 0.0f;
    LobeWeights::PixelLobe lobe_there = LobeWeights::of(there);
    vec3 apart_ws = before_.seen.positions_ws[tap] - now_.positions_ws[here.index];
    if (here.rests) {
      // Directions differ by the jitter within the pixel, over which mirrors are averaged, too
      lobe_there.mirror_ws = here.guide.mirror_ws;
      apart_ws = vec3(0.0f);
    }
    return LobeWeights::falloff(LobeWeights::difference_of_lobes(
        lobe_scale_, LobeWeights::of(here.guide), lobe_there, apart_ws, here.guide.across_ws));
  }

  const FrameAveraging& by_;
  const SurfacesSeen& now_;
  SurfacesBefore before_;
  const LobeHistory& last_;
  float lobe_scale_;
};

/// Averages light with the weighted mean of the history's.
void average(const std::vector<vec3>& before, const LobeTaps& found, float frames, vec3& light) {
  light = finite_or_dark(light);
  if (frames > 1.0f) {
    light = mix(weighted_sum(before, found.taps) / found.share, light, 1.0f / frames);
  }
}

}  // namespace

void average_reflected_light(const FrameAveraging& by, const SurfacesSeen& now,
                             const SurfacesSeen& before, const LobeHistory& last,
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
      if (has_history) found = finder.find(i, lobes.to_viewer_ws[i], guide);
      float frames = 1.0f;
      if (found.share > 0.0f) {
        float most = by.most_frames;
        if (by.moved != nullptr) {
          most = std::min(most, by.moved->frames_of_lobe(now.positions_ws[i], guide));
        }
        frames = averaged_frames(weighted_sum(last.frames, found.taps), most);
      }
      average(last.light, found, frames, lobes.light[i]);
      if (!lobes.excess.empty()) average(last.excess, found, frames, lobes.excess[i]);
      if (!lobes.variance.empty()) lobes.variance[i] /= frames;
      next.lobes[i] = guide;
      next.light[i] = lobes.light[i];
      if (!lobes.excess.empty()) next.excess[i] = lobes.excess[i];
      next.frames[i] = frames;
    }
  });
}

}  // namespace lambent
