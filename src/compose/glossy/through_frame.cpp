// SPDX-License-Identifier: Apache-2.0
// Rays through the surfaces of pixels, on the processor. They are traced like those of coats, but
// paths split, and the light of the first opaque surfaces is stored apart.
#include <algorithm>
#include <utility>

#include "compose/frame_tasks.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/glossy/path_rays.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"

namespace lambent {

/// Draws the rays of pixels whose surfaces transmit light. Returns how many there are.
std::uint64_t Glossy::send_through(const GlossySettings& settings, const GBuffer& seen) {
  const uint first_index = static_cast<uint>(first_row_) * static_cast<uint>(settings.frame.width);
  std::uint64_t sent = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Surface& surface = seen.surfaces[i];
    rays_[i].distance = -1.0f;
    if (seen.hit[i] == 0 || !is_transmissive(surface.transmission)) continue;
    RandomStream random = make_random_stream(first_index + static_cast<uint>(i),
                                             coat_salt(salt_, 0u), ~settings.frame.seed);
    CoatPath& path = paths_.paths[i];
    path = begin_path_through_glass(
        surface.transmission.alpha,
        branch_number(first_index + static_cast<uint>(i), static_cast<uint>(settings.sample),
                      settings.frame.seed));
    const vec2 u = next_uniform2(random);
    const NextRay next = extend_through_glass(
        surface.transmission, surface.reflectance, surface.normal_ws, seen.to_viewer_ws[i],
        reflected_density_scale(settings, surface), vec3(u, next_uniform(random)), path);
    paths_.next[i] = ray_from(surface, next);
    paths_.cones[i] = reflected_cone(pixel_cone(settings, surface, seen.to_viewer_ws[i]), path.pdf);
    sent += path.pdf > 0.0f ? 1 : 0;
  }
  return sent;
}

/// Stores the light of the first opaque surfaces behind glass apart: that of emitters, and all
/// light of their coats. Elsewhere, emitters' light joins the other direct light.
void Glossy::keep_behind(const GlossySettings& settings, const KeptBehind& kept) {
  const bool has_emitters = !direct_.emitters.empty();
  parallel_chunks(met_.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (met_.hit[i] == 0) continue;
      const Surface& surface = met_.surfaces[i];
      CoatPath& path = paths_.paths[i];
      if (!reaches_opaque_surface(path, surface.transmission)) {
        if (has_emitters) direct_.diffuse[i] += direct_.emitters[i] + direct_.emitter_specular[i];
        continue;
      }
      path.stage = kStageBehindGlass;
      SeenThrough& seen = *kept.seen;
      const std::size_t pixel = kept.first + i;
      seen.depths[pixel] = distance(surface.position_ws, settings.camera.position_ws);
      seen.positions_ws[pixel] = surface.position_ws;
      seen.normals_ws[pixel] = surface.normal_ws;
      seen.coat_to_viewer_ws[pixel] = met_.to_viewer_ws[i];
      seen.coat_alphas[pixel] = alpha_behind(surface.reflectance, met_.coat_shares[i].coat);
      seen.coat_albedo[pixel] = coat_albedo_behind(path, surface.reflectance,
                                                   dot(surface.normal_ws, met_.to_viewer_ws[i]));
      if (gathers_behind_) {
        bases_behind_[i] =
            shown_base(surface.position_ws, surface.normal_ws, surface.geometric_normal_ws,
                       surface.gi_share, surface.reflectance, met_.to_viewer_ws[i],
                       distance(surface.position_ws, paths_.next[i].origin), path,
                       !has_no_base(surface.reflectance));
      }
      if (!direct_.sky.empty()) {
        rays_[i].apart += path.throughput * direct_.sky[i];
        direct_.sky[i] = vec3(0.0f);
      }
      if (!has_emitters) continue;
      rays_[i].apart += path.throughput * direct_.emitter_specular[i];
      const FilteredEmitter emitter =
          filtered_emitter(surface.reflectance, direct_.emitters[i], direct_.unoccluded[i]);
      seen.emitters[pixel] = emitter.light;
      seen.emitter_levels[pixel] = emitter.level;
      seen.emitter_albedo[pixel] = path.throughput * emitter.albedo;
      if (direct_.emitter_variance.empty()) continue;
      seen.emitter_variance[pixel] = filtered_variance(emitter, direct_.emitter_variance[i]);
    }
  });
}

/// Keeps one of the branches of each path that splits at glass.
void Glossy::split_paths(const GlossySettings& settings, std::uint32_t bounce) {
  const uint first_index = static_cast<uint>(first_row_) * static_cast<uint>(settings.frame.width);
  const uint step = path_step(settings, bounce);
  parallel_chunks(met_.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (met_.hit[i] == 0) continue;
      const Surface& surface = met_.surfaces[i];
      const float n_dot_v = dot(surface.normal_ws, met_.to_viewer_ws[i]);
      CoatPath& path = paths_.paths[i];
      if (!forks(path, surface.transmission, surface.reflectance, met_.coat_shares[i].coat, n_dot_v,
                 bounce)) {
        continue;
      }
      const RandomStream random = make_random_stream(
          first_index + static_cast<uint>(i), coat_salt(salt_, bounce), ~settings.frame.seed);
      CoatPath branch;
      const NextRay next =
          split(surface.transmission, surface.reflectance, met_.coat_shares[i], surface.normal_ws,
                surface.geometric_normal_ws, met_.to_viewer_ws[i],
                reflected_density_scale(settings, surface), step, random, path, branch);
      const float weight = branch_weight(branch);
      if (weight <= 0.0f) continue;
      float factor = 1.0f;
      if (keeps_branch(weight, path.branches, factor)) {
        forks_.paths[i] = branch;
        forks_.next[i] = ray_from(surface, next);
        forks_.cones[i] = reflected_cone(paths_.cones[i], branch.pdf);
      }
      forks_.paths[i].throughput *= factor;
    }
  });
}

std::uint64_t Glossy::look_through(const GlossySettings& settings, const GlossyRows& band,
                                   const KeptBehind& kept, TransmittedLight& light) {
  start(settings, band.first_row, band.pixels.size(), kThroughSalt);
  forks_.start(band.pixels.size());
  gathers_behind_ = kept.seen != nullptr && settings.gathers_shown;
  bases_behind_.assign(gathers_behind_ ? band.pixels.size() : 0, no_shown_base());
  const std::uint64_t sent = send_through(settings, band.pixels);
  std::uint64_t traced = samples_behind_ ? sample_lights_behind(settings, band.pixels, 0) : 0;
  traced += follow_all(settings, sent, 1, kept);
  const auto goes_on = [](const CoatPath& path) { return path.pdf > 0.0f; };
  const auto going = std::count_if(forks_.paths.begin(), forks_.paths.end(), goes_on);
  std::swap(paths_, forks_);
  forks_.start(0);
  traced += follow_all(settings, static_cast<std::uint64_t>(going), kFirstBounceOfForks, kept);
  light.bases.swap(bases_behind_);
  light.light.resize(rays_.size());
  light.long_ways.resize(rays_.size());
  light.distances.resize(rays_.size());
  light.coats_behind.resize(rays_.size());
  light.coat_distances.resize(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    light.light[i] = rays_[i].radiance;
    light.long_ways[i] = rays_[i].mirrored;
    if (kept.seen == nullptr) light.light[i] += light.long_ways[i];
    light.distances[i] = rays_[i].distance;
    light.coats_behind[i] = rays_[i].apart;
    light.coat_distances[i] = coat_distances_[i];
  }
  return traced;
}

std::uint64_t look_through_band(const FrameRequest& request, const Band& band, int sample,
                                const GBuffer& pixels, const KeptBehind& kept, GlossyMemory& memory,
                                TransmittedLight& light) {
  return memory.coats.look_through(glossy_settings(request, request.settings, sample),
                                   {pixels, band.first_row}, kept, light);
}

}  // namespace lambent
