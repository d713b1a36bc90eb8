// SPDX-License-Identifier: Apache-2.0
#include "compose/rsm/direct_frame.h"

#include <atomic>

#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/world_access.h"
#include "rsm/deinterleave.h"
#include "scene/media/media.h"
#include "shared/demodulate.h"

namespace lambent {
namespace {

// Approximate number of shadow rays that are traced together.
constexpr std::size_t kRaysAtOnce = std::size_t{1} << 14;

/// A pixel of a row of a sub-image.
struct RowPixel {
  std::size_t in_band, in_view;
  Frame frame;
  vec3 to_viewer;
  LitPoint point;
  BrightestLight brightest = no_brightest_light();  // used where lights are shared out
};

/// Light that a pixel receives if a shadow ray is unoccluded.
struct PendingLight {
  std::size_t in_view;
  ReflectedPair light;
  bool is_share;  // counts for the pixel's LightShare; otherwise for its own light
};

/// Computes the light of a sub-image's row, one light after the other, so that a batch's rays go
/// towards the same light.
class RowShading {
 public:
  RowShading(const World& world, const Media& media, const GBuffer& gbuffer, DirectView& view)
      : world_(world), media_(media), gbuffer_(gbuffer), view_(view) {}

  void add_pixel(std::size_t in_band, std::size_t in_view) {
    const ReflectedPair none = {vec3(0.0f), vec3(0.0f)};
    view_.direct[in_view] = none;
    if (view_.lights.shared()) {
      view_.brightest[in_view] = none;
      view_.shares[in_view] = {vec3(0.0f), vec3(0.0f)};
    }
    if (gbuffer_.hit[in_band] == 0) return;
    const Surface& surface = gbuffer_.surfaces[in_band];
    const Frame frame = make_frame(surface.normal_ws);
    pixels_.push_back({in_band,
                       in_view,
                       frame,
                       to_local(frame, gbuffer_.to_viewer_ws[in_band]),
                       {surface.position_ws, surface.normal_ws, surface.geometric_normal_ws}});
  }

  /// Returns the number of shadow rays traced.
  std::uint64_t shade(int sub_map) {
    if (view_.lights.shared()) find_brightest();
    for (const AssignedLight& dealt : view_.lights.of(sub_map)) {
      for (const RowPixel& pixel : pixels_) ask(pixel, dealt);
    }
    trace();
    pixels_.clear();
    return std::exchange(rays_, 0);
  }

 private:
  const LightRecord& record_of(std::size_t light) const {
    return lights_of(world_).lights()[light];
  }

  /// Unoccluded light of a light at a pixel; diffuse light is divided by filtered_albedo().
  ReflectedPair sent(const RowPixel& pixel, const LightCandidate& light) const {
    if (light.perpendicular_irradiance == vec3(0.0f)) return {vec3(0.0f), vec3(0.0f)};
    const Surface& surface = gbuffer_.surfaces[pixel.in_band];
    ReflectedPair pair = sampled_reflection(surface.reflectance, pixel.frame, pixel.to_viewer,
                                            pixel.point, light, {}, 0.0f);
    if (!media_.empty()) {
      const float passed =
          transmittance(media_, pixel.point.position_ws, light.to_light, light.distance);
      pair.diffuse *= passed;
      pair.specular *= passed;
    }
    pair.diffuse /= filtered_albedo(surface.reflectance);
    return pair;
  }

  /// Sums up the unoccluded light of all lights but each pixel's brightest one, which is tested.
  void find_brightest() {
    for (std::size_t light = 0; light < view_.lights.lights; ++light) {
      for (RowPixel& pixel : pixels_) {
        const LightCandidate candidate = punctual_candidate(record_of(light), pixel.point);
        add_to_others(pixel.brightest, static_cast<uint>(light), sent(pixel, candidate),
                      view_.direct[pixel.in_view]);
      }
    }
    for (const RowPixel& pixel : pixels_) {
      if (pixel.brightest.light == kNoLight) continue;
      const LightRecord& light = record_of(pixel.brightest.light);
      queue(pixel, punctual_candidate(light, pixel.point), pixel.brightest.sent, false);
    }
  }

  void ask(const RowPixel& pixel, const AssignedLight& dealt) {
    if (dealt.light == pixel.brightest.light) return;
    const LightCandidate candidate = punctual_candidate(record_of(dealt.light), pixel.point);
    ReflectedPair pair = sent(pixel, candidate);
    if (pair.diffuse + pair.specular == vec3(0.0f)) return;
    pair.diffuse *= dealt.weight;
    pair.specular *= dealt.weight;
    const bool is_share = view_.lights.shared();
    if (is_share) view_.shares[pixel.in_view].sent += pair.diffuse + pair.specular;
    queue(pixel, candidate, pair, is_share);
  }

  void queue(const RowPixel& pixel, const LightCandidate& candidate, const ReflectedPair& pair,
             bool is_share) {
    pending_.push_back({pixel.in_view, pair, is_share});
    rays_to_trace_.push_back(
        shadow_ray(pixel.point.position_ws, pixel.point.geometric_normal_ws, candidate));
    if (rays_to_trace_.size() >= kRaysAtOnce) trace();
  }

  void trace() {
    std::vector<ReflectedPair>& own = view_.lights.shared() ? view_.brightest : view_.direct;
    shadows_.trace(tracer_of(world_), rays_to_trace_);
    for (std::size_t k = 0; k < pending_.size(); ++k) {
      const vec3 share = shadows_.share(k);
      if (share == vec3(0.0f)) continue;
      const auto& [in_view, light, is_share] = pending_[k];
      if (is_share) {
        view_.shares[in_view].arrived += share * (light.diffuse + light.specular);
      } else {
        own[in_view].diffuse += share * light.diffuse;
        own[in_view].specular += share * light.specular;
      }
    }
    rays_ += rays_to_trace_.size();
    rays_to_trace_.clear();
    pending_.clear();
  }

  const World& world_;
  const Media& media_;
  const GBuffer& gbuffer_;
  DirectView& view_;
  std::vector<RowPixel> pixels_;
  std::vector<PendingLight> pending_;
  std::vector<Ray> rays_to_trace_;
  ShadowRays shadows_;
  std::uint64_t rays_ = 0;
};

/// The view, as the blur reads it.
struct ShareView {
  ShareView(const RsmView& view, std::span<const LightShare> of) : seen(view), shares(of) {}

  vec3 fetch_position(int pixel) { return seen.positions_ws[pixel]; }
  vec3 fetch_normal(int pixel) { return seen.normals_ws[pixel]; }
  float fetch_depth(int pixel) { return seen.depths[pixel]; }
  LightShare fetch_share(int pixel) { return shares[pixel]; }

#include "rsm/share_blur.inl.h"

  const RsmView& seen;
  std::span<const LightShare> shares;
};

/// Calls body(pixel, share) for all pixels, with the shares around them along an axis.
template <class Body>
void blur_shares(const RsmView& seen, std::span<const LightShare> shares, const ivec2& axis,
                 int period, float plane_tolerance, Body body) {
  parallel_chunks(static_cast<std::size_t>(seen.height), 1, [&](std::size_t y, std::size_t) {
    ShareView view(seen, shares);
    for (int x = 0; x < seen.width; ++x) {
      const ivec2 at(x, static_cast<int>(y));
      body(y * static_cast<std::size_t>(seen.width) + static_cast<std::size_t>(x),
           view.blurred_share(at, {seen.width, seen.height}, axis, period, 1.0f / plane_tolerance));
    }
  });
}

}  // namespace

void start_direct_view(const World& world, const RsmSettings& settings, std::size_t pixels,
                       DirectView& view) {
  view.lights = deal_direct_lights(world.scene().lights.size(), settings);
  view.direct.resize(pixels);
  const std::size_t shared = view.lights.shared() ? pixels : 0;
  view.brightest.resize(shared);
  view.shares.resize(shared);
  view.blurred.resize(share_period(view.lights, settings) > 1 ? shared : 0);
}

std::uint64_t shade_direct_view(const World& world, const RsmSettings& settings,
                                const GBuffer& gbuffer, const Band& band, int width,
                                DirectView& view) {
  const Media media(world.scene().fog);
  const int p = settings.sub_images;
  std::atomic<std::uint64_t> rays = 0;
  parallel_chunks(static_cast<std::size_t>(band.rows), 1, [&](std::size_t row, std::size_t) {
    const int y = band.first_row + static_cast<int>(row);
    RowShading shading(world, media, gbuffer, view);
    for (int i = 0; i < std::min(p, width); ++i) {
      for (int x = i; x < width; x += p) {
        shading.add_pixel(row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
                          static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
      }
      rays += shading.shade(sub_map_of(sub_image_of({i, y}, p), settings.sub_maps));
    }
  });
  return rays;
}

void finish_direct_view(const RsmView& seen, const RsmSettings& settings, DirectView& view) {
  if (!view.lights.shared()) return;
  const int period = share_period(view.lights, settings);
  if (period > 1) {
    blur_shares(seen, view.shares, {1, 0}, period, settings.plane_tolerance,
                [&](std::size_t i, const LightShare& share) { view.blurred[i] = share; });
  }
  blur_shares(seen, period > 1 ? view.blurred : view.shares, {0, 1}, period,
              settings.plane_tolerance, [&](std::size_t i, const LightShare& share) {
                view.direct[i] =
                    with_brightest(view.brightest[i], view.direct[i], arriving_share(share));
              });
}

}  // namespace lambent
