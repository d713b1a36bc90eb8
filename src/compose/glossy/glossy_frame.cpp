// SPDX-License-Identifier: Apache-2.0
#include "compose/glossy/glossy_frame.h"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "raytracing/world_access.h"
#include "scene/environment_sampling.h"
#include "shared/rays.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 1024;

/// The ray that leaves a surface.
Ray ray_from(const Surface& surface, const NextRay& next) {
  Ray ray;
  ray.origin = offset_ray_origin(surface.position_ws, next.side * surface.geometric_normal_ws);
  ray.direction = next.direction_ws;
  return ray;
}

/// Asks the field for light from around `direction_ws` where a ray met a surface.
FieldQuery query_of(const Ray& ray, const Surface& met, const vec3& direction_ws) {
  return {met.position_ws, direction_ws, -ray.direction, distance(met.position_ws, ray.origin)};
}

/// The cone of a pixel's ray where it ends.
RayCone pixel_cone(const GlossySettings& settings, const Surface& surface,
                   const vec3& to_viewer_ws) {
  RayCone cone = camera_cone(settings.camera, -to_viewer_ws,
                             static_cast<uint>(settings.frame.samples), settings.jitter);
  cone.width = width_at(cone, length(surface.position_ws - settings.camera.position_ws));
  return cone;
}

}  // namespace

void find_coat_shares(GBuffer& pixels) {
  pixels.coat_shares.resize(pixels.size());
  pixels.clearcoat_shares.clear();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const bool shines = pixels.hit[i] != 0 && pixels.surfaces[i].gi_share > 0.0f;
    pixels.coat_shares[i] = shines ? traced_coat_share(pixels.surfaces[i].reflectance) : 0.0f;
    if (!shines || !has_clearcoat(pixels.surfaces[i].reflectance.layers)) continue;
    pixels.clearcoat_shares.resize(pixels.size());
    pixels.clearcoat_shares[i] =
        traced_coat_share(clearcoat_alone(pixels.surfaces[i].reflectance.layers));
  }
}

/// Makes room for the rays of so many pixels, none of which has one yet.
void Glossy::start(const GlossySettings& settings, int first_row, std::size_t pixels, uint salt) {
  first_row_ = first_row;
  salt_ = static_cast<uint>(settings.sample) ^ salt;
  rays_.assign(pixels, {vec3(0.0f, 0.0f, 1.0f), infinity(), vec3(0.0f), 0.0f, vec3(0.0f)});
  paths_.assign(pixels, {vec3(1.0f), 0.0f, 0.0f, kStageOther});
  next_.resize(pixels);
  cones_.resize(pixels);
  coat_distances_.assign(pixels, -1.0f);
}

/// Draws the rays of pixels whose surfaces let light through.
std::uint64_t Glossy::send_through(const GlossySettings& settings, const GBuffer& seen) {
  const uint first_index = static_cast<uint>(first_row_) * static_cast<uint>(settings.frame.width);
  std::uint64_t sent = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Surface& surface = seen.surfaces[i];
    rays_[i].distance = -1.0f;
    if (seen.hit[i] == 0 || !lets_light_through(surface.transmission)) continue;
    RandomStream random = make_random_stream(first_index + static_cast<uint>(i),
                                             coat_salt(salt_, 0u), ~settings.frame.seed);
    CoatPath& path = paths_[i];
    path = {vec3(1.0f), kFoundByNobodyElse, surface.transmission.alpha, kStageOther};
    const vec2 u = next_uniform2(random);
    const NextRay next = go_on_through(surface.transmission, surface.reflectance, surface.normal_ws,
                                       seen.to_viewer_ws[i], vec3(u, next_uniform(random)), path);
    next_[i] = ray_from(surface, next);
    cones_[i] = reflected_cone(pixel_cone(settings, surface, seen.to_viewer_ws[i]), path.pdf);
    sent += path.pdf > 0.0f ? 1 : 0;
  }
  return sent;
}

/// Draws the pixels' rays.
std::uint64_t Glossy::send_rays(const GlossySettings& settings,
                                std::span<const GlossyRows> around) {
  std::size_t pixels = 0;
  for (const GlossyRows& rows : around) pixels += rows.pixels.size();
  start(settings, around.front().first_row, pixels, 0u);

  const auto rows_between = static_cast<uint>(settings.frame.glossy_rows);
  const auto sample = static_cast<uint>(settings.sample);
  const auto width = static_cast<std::size_t>(settings.frame.width);
  std::atomic<std::uint64_t> sent = 0;
  std::size_t first = 0;
  for (const GlossyRows& rows : around) {
    const GBuffer& seen = rows.pixels;
    parallel_chunks(seen.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
      std::uint64_t count = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const int y = rows.first_row + static_cast<int>(i / width);
        const Surface& surface = seen.surfaces[i];
        if (!traces_coat(surface.reflectance, seen.coat_shares[i], y, sample, rows_between)) {
          continue;
        }
        const vec2 u =
            coat_uniforms(uvec2(i % width, y), sample, rows_between, settings.frame.seed);
        const CoatDraw drawn = draw_coat_ray(surface.reflectance, make_frame(surface.normal_ws),
                                             seen.to_viewer_ws[i], u);
        if (drawn.pdf <= 0.0f) {
          rays_[first + i].pdf = -1.0f;
          continue;
        }
        rays_[first + i].direction_ws = drawn.direction_ws;
        rays_[first + i].pdf = drawn.pdf;
        paths_[first + i] = {vec3(1.0f), drawn.pdf, surface.reflectance.alpha, kStageOwnCoat};
        next_[first + i] = ray_from(surface, {drawn.direction_ws, 1.0f});
        cones_[first + i] =
            reflected_cone(pixel_cone(settings, surface, seen.to_viewer_ws[i]), drawn.pdf);
        ++count;
      }
      sent += count;
    });
    first += seen.size();
  }
  return sent;
}

/// Finds what rays met, and adds the light that they bring but for what is looked up: of the sky
/// and of what emits. Returns the rays traced.
std::uint64_t Glossy::follow_rays(const GlossySettings& settings, std::uint32_t bounce) {
  const Scene& scene = settings.world.scene();
  std::atomic<std::uint64_t> traced = 0;
  met_.surfaces.resize(rays_.size());
  met_.hit.resize(rays_.size());
  met_.to_viewer_ws.resize(rays_.size());
  met_.coat_shares.assign(rays_.size(), 0.0f);
  parallel_chunks(rays_.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    std::vector<std::size_t> pixels;
    for (std::size_t i = begin; i < end; ++i) {
      met_.hit[i] = 0;
      if (paths_[i].pdf <= 0.0f) continue;
      rays.push_back(next_[i]);
      pixels.push_back(i);
    }
    std::vector<Hit> hits(rays.size());
    tracer_of(settings.world).closest_hits(rays, hits);
    prefetch_surfaces(scene, hits);
    traced += rays.size();
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::size_t i = pixels[k];
      CoatPath& path = paths_[i];
      met_.to_viewer_ws[i] = -rays[k].direction;
      rays_[i].distance = distance_met(path, bounce, rays_[i].distance, hits[k].distance);
      if (path.stage == kStageCoatBehindGlass) {
        coat_distances_[i] = farther_seen(coat_distances_[i], hits[k].distance);
      }
      if (hits[k].missed()) {
        bring_light(path, sky_radiance(scene.environment, rays[k].direction), rays_[i]);
        path.pdf = 0.0f;
        continue;
      }
      cones_[i].width = width_at(cones_[i], hits[k].distance);
      const Surface surface = seen_surface_at(scene, rays[k], hits[k], cones_[i].width);
      if (path.stage == kStageCoatBehindGlass && !lets_light_through(surface.transmission)) {
        path.stage = kStageBeyondCoat;
      }
      path.throughput *= left_of_light(surface.transmission, hits[k].distance);
      met_.hit[i] = 1;
      met_.surfaces[i] = surface;
      meet_emitter(path, surface.emission,
                   static_cast<uint>(settings.frame.reflected_emissive_samples), rays_[i]);
      met_.coat_shares[i] = meet_coat(dot(surface.normal_ws, met_.to_viewer_ws[i]),
                                      settings.field != nullptr ? surface.gi_share : 0.0f, bounce,
                                      met_.surfaces[i].reflectance, path);
    }
  });
  return traced;
}

/// Adds the light of the field and of lights that the rays' hits reflect, and draws the rays that
/// go on from there. Returns how many these are.
std::uint64_t Glossy::light_hits(const GlossySettings& settings, std::uint32_t bounce) {
  // Ask for the light of bases, and of what coats have from no ray
  queries_.clear();
  asked_.clear();
  const auto ask = [&](std::size_t i, const vec3& direction_ws) {
    queries_.push_back(query_of(next_[i], met_.surfaces[i], direction_ws));
    asked_.push_back(i);
  };
  const auto asks_for_base = [&](const Surface& surface) {
    return surface.gi_share > 0.0f && !has_no_base(surface.reflectance);
  };
  for (std::size_t i = 0; i < met_.size(); ++i) {
    if (met_.hit[i] == 0) continue;
    if (asks_for_base(met_.surfaces[i])) ask(i, met_.surfaces[i].normal_ws);
  }
  const std::size_t of_bases = queries_.size();
  for (std::size_t i = 0; i < met_.size(); ++i) {
    if (met_.hit[i] == 0) continue;
    const Surface& surface = met_.surfaces[i];
    if (surface.gi_share <= 0.0f || has_no_coat(surface.reflectance)) continue;
    if (met_.coat_shares[i] >= 1.0f && !has_clearcoat(surface.reflectance.layers)) continue;
    ask(i, coats_direction(surface.reflectance, met_.coat_shares[i], surface.normal_ws,
                           met_.to_viewer_ws[i]));
  }
  answers_.assign(queries_.size(), vec3(0.0f));
  if (settings.field != nullptr) settings.field->irradiance(queries_, answers_, &settings.world);

  for (std::size_t k = 0; k < queries_.size(); ++k) {
    const std::size_t i = asked_[k];
    const Surface& surface = met_.surfaces[i];
    const float n_dot_v = dot(surface.normal_ws, met_.to_viewer_ws[i]);
    const vec3 light = k < of_bases ? reflected_indirect(surface.reflectance, n_dot_v,
                                                         surface.gi_share * answers_[k])
                                    : coats_light(surface.reflectance, n_dot_v, surface.gi_share,
                                                  met_.coat_shares[i], answers_[k]);
    bring_light(paths_[i], light, rays_[i]);
  }
  const uint first_index = static_cast<uint>(first_row_) * static_cast<uint>(settings.frame.width);
  std::atomic<std::uint64_t> going_on = 0;
  parallel_chunks(met_.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::uint64_t going = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (met_.hit[i] == 0) continue;
      const Surface& surface = met_.surfaces[i];
      CoatPath& path = paths_[i];
      bring_light(path, direct_.diffuse[i] + direct_.specular[i], rays_[i]);
      const RandomStream random = make_random_stream(
          first_index + static_cast<uint>(i), coat_salt(salt_, bounce), ~settings.frame.seed);
      const NextRay next =
          go_on(surface.transmission, surface.reflectance, met_.coat_shares[i], surface.normal_ws,
                surface.geometric_normal_ws, met_.to_viewer_ws[i], bounce, random, path);
      if (path.pdf <= 0.0f) continue;
      next_[i] = ray_from(surface, next);
      cones_[i] = reflected_cone(cones_[i], path.pdf);
      ++going;
    }
    going_on += going;
  });
  return going_on;
}

/// Keeps apart what lights up the first surfaces behind glass that let no light through: light of
/// emitters, and all light of their coats. Elsewhere that of emitters is part of other direct
/// light.
void Glossy::keep_behind(const GlossySettings& settings, const KeptBehind& kept) {
  const bool has_emitters = !direct_.emitters.empty();
  parallel_chunks(met_.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (met_.hit[i] == 0) continue;
      const Surface& surface = met_.surfaces[i];
      CoatPath& path = paths_[i];
      if (path.stage != kStageOther || lets_light_through(surface.transmission)) {
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
      seen.coat_alphas[pixel] = alpha_behind(surface.reflectance, met_.coat_shares[i]);
      seen.coat_albedo[pixel] = coat_albedo_behind(path, surface.reflectance,
                                                   dot(surface.normal_ws, met_.to_viewer_ws[i]));
      if (!has_emitters) continue;
      rays_[i].apart += path.throughput * direct_.emitter_specular[i];
      const FilteredEmitter emitter =
          filtered_emitter(surface.reflectance, direct_.emitters[i], direct_.unoccluded[i]);
      seen.emitters[pixel] = emitter.light;
      seen.emitter_levels[pixel] = emitter.level;
      seen.emitter_albedo[pixel] = path.throughput * emitter.albedo;
      if (direct_.emitter_variance.empty()) continue;
      seen.emitter_variance[pixel] =
          emitter.inverse * emitter.inverse * direct_.emitter_variance[i];
    }
  });
}

/// Follows rays until all their ways have ended; returns the rays traced.
std::uint64_t Glossy::follow_all(const GlossySettings& settings, std::uint64_t going,
                                 const KeptBehind& kept) {
  FrameSettings lighting = settings.frame;
  lighting.denoise = kept.seen != nullptr;
  lighting.emissive_samples = settings.frame.reflected_emissive_samples;
  std::uint64_t traced = 0;
  for (std::uint32_t bounce = 1; going > 0 && bounce <= kMaxWays; ++bounce) {
    traced += follow_rays(settings, bounce);
    traced += shade_direct(settings.world, met_, lighting, {first_row_, 0},
                           static_cast<int>(coat_salt(salt_, bounce)), false, direct_);
    if (kept.seen != nullptr) keep_behind(settings, kept);
    going = light_hits(settings, bounce);
  }
  return traced;
}

std::uint64_t Glossy::look_through(const GlossySettings& settings, const GlossyRows& band,
                                   const KeptBehind& kept, TransmittedLight& light) {
  start(settings, band.first_row, band.pixels.size(), kThroughSalt);
  const std::uint64_t traced = follow_all(settings, send_through(settings, band.pixels), kept);
  light.light.resize(rays_.size());
  light.distances.resize(rays_.size());
  light.coats_behind.resize(rays_.size());
  light.coat_distances.resize(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    light.light[i] = rays_[i].radiance;
    light.distances[i] = rays_[i].distance;
    light.coats_behind[i] = rays_[i].apart;
    light.coat_distances[i] = coat_distances_[i];
  }
  return traced;
}

std::uint64_t Glossy::reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
                              const GlossyRows& band, CoatLight& light) {
  const std::uint64_t traced = follow_all(settings, send_rays(settings, around), {});
  reuse_.reflect(settings, around, band, rays_, light);
  return traced;
}

std::uint64_t reflect_band(const FrameRequest& request, const Band& band, int sample, CoatKind kind,
                           const GBuffer& pixels, GlossyMemory& memory, CoatLight& light) {
  light.clear();
  if (!traces_coats(request)) return 0;
  const std::vector<float>& shares = pixels.coat_shares;
  const auto shines = [](float share) { return share > 0.0f; };
  if (std::none_of(shares.begin(), shares.end(), shines)) return 0;
  const FrameSettings& settings = request.settings;
  FrameSettings drawing = settings;
  if (kind == CoatKind::clearcoat) {
    drawing.seed = clearcoat_seed(settings.seed);
    drawing.denoise = false;  // nobody asks how far away what clearcoats show is
  }
  const int halo = glossy_halo(settings.glossy_rows);
  const int end_row = band.first_row + band.rows;
  const Band above{std::max(0, band.first_row - halo), std::min(halo, band.first_row)};
  const Band below{end_row, std::min(halo, settings.height - end_row)};
  std::uint64_t traced = 0;
  const auto see = [&](const Band& rows, GBuffer& seen) {
    trace_gbuffer(request.world, request.camera, settings, rows, sample, seen, request.jitter());
    if (kind == CoatKind::clearcoat) show_clearcoats(seen);
    find_coat_shares(seen);
    traced += seen.size();
  };
  see(above, memory.above);
  see(below, memory.below);
  const GlossyRows own{pixels, band.first_row};
  const GlossyRows around[] = {
      {memory.above, above.first_row}, own, {memory.below, below.first_row}};
  const GlossySettings glossy{
      request.world, request.sources.field,
      drawing,       camera_record(request.camera, settings.width, settings.height),
      sample,        request.jitter()};
  return traced + memory.coats.reflect(glossy, around, own, light);
}

std::uint64_t look_through_band(const FrameRequest& request, const Band& band, int sample,
                                const GBuffer& pixels, const KeptBehind& kept, GlossyMemory& memory,
                                TransmittedLight& light) {
  const FrameSettings& settings = request.settings;
  const GlossySettings through{
      request.world, request.sources.field,
      settings,      camera_record(request.camera, settings.width, settings.height),
      sample,        request.jitter()};
  return memory.coats.look_through(through, {pixels, band.first_row}, kept, light);
}

void look_up_coats(const FrameRequest& request, const GBuffer& pixels, const CoatLight& by_rays,
                   GlossyMemory& memory, std::vector<glm::vec3>& irradiance) {
  irradiance.assign(pixels.size(), vec3(0.0f));
  memory.queries.clear();
  memory.asked.clear();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Surface& surface = pixels.surfaces[i];
    if (pixels.hit[i] == 0 || surface.reflectance.f90 <= 0.0f) continue;
    if (!by_rays.empty() && by_rays.light[i].w >= 1.0f) continue;
    const vec3& to_viewer_ws = pixels.to_viewer_ws[i];
    memory.queries.push_back(
        {surface.position_ws,
         coat_direction(surface.normal_ws, to_viewer_ws, surface.reflectance.alpha), to_viewer_ws});
    memory.asked.push_back(i);
  }
  memory.answers.resize(memory.queries.size());
  request.sources.field->irradiance(memory.queries, memory.answers, &request.world);
  for (std::size_t k = 0; k < memory.asked.size(); ++k) {
    irradiance[memory.asked[k]] = memory.answers[k];
  }
}

}  // namespace lambent
