// SPDX-License-Identifier: Apache-2.0
#include "compose/glossy/ray_reuse.h"

#include <cstdlib>

#include "core/parallel.h"
#include "raytracing/direct_light.h"

namespace lambent {
namespace {

float distance_of(const CoatRay& ray) {
  return seen_distance(ray);
}
float distance_of(const MirroredCoat& coat) {
  return seen_distance(coat.alpha, coat.seen_distance);
}

/// Rays, or coats in mirrors, of the pixels of the rows around a band.
template <class Record>
struct SeenAround {
  using CoatViewRef = const SeenAround&;
  static float fetch_distance(CoatViewRef view, ivec2 pixel) {
    const int place = (pixel.y - view.first_row) * view.picture_size.x + pixel.x;
    return distance_of(view.records[static_cast<std::size_t>(place)]);
  }
  static ivec2 view_size(CoatViewRef view) { return view.picture_size; }

#include "glossy/seen_distance.inl.h"

  std::span<const Record> records;
  int first_row;
  ivec2 picture_size;  // [pixels]
};

/// The rows of rays around a row of the picture; the outermost have half their weight.
std::vector<NeighbourRow> rows_around(const GlossySettings& settings, int row, int first_row) {
  const int between = settings.frame.glossy_rows;
  const int reach = kReuse * between;
  std::vector<NeighbourRow> rows;
  for (int dy = -reach; dy <= reach; ++dy) {
    const int y = row + dy;
    if (y < 0 || y >= settings.frame.height) continue;
    if (!has_coat_rays(y, static_cast<uint>(settings.sample), static_cast<uint>(between))) continue;
    rows.push_back({y - first_row, std::abs(dy) == reach ? 0.5f : 1.0f, dy == 0});
  }
  return rows;
}

}  // namespace

CoatLobe lobe_of(const GBuffer& pixels, std::size_t pixel) {
  const Surface& surface = pixels.surfaces[pixel];
  return make_coat_lobe(surface.position_ws, surface.geometric_normal_ws, surface.normal_ws,
                        pixels.to_viewer_ws[pixel], surface.reflectance.alpha);
}

CoatReceiver receiver_of(const GlossySettings& settings, const GBuffer& pixels, std::size_t pixel,
                         const CoatRay& own) {
  const Surface& surface = pixels.surfaces[pixel];
  CoatReceiver at{
      lobe_of(pixels, pixel),
      coat_under_layers(surface.reflectance, dot(surface.normal_ws, pixels.to_viewer_ws[pixel])),
      inverse_plane_tolerance(settings.camera, surface.position_ws),
      own,
      {},
      {},
      0.0f,
      emitter_density_scale(settings.world, settings.frame.emissive_samples, surface.position_ws)};
  find_lobe(at);
  return at;
}

/// Writes all that neighbours read into planes.
void RayReuse::lay_out(const GlossySettings& settings, std::span<const GlossyRows> around,
                       std::span<const CoatRay> rays) {
  const int width = settings.frame.width;
  coats_.resize(kCoatPlanes, width, static_cast<int>(rays.size()) / width);
  const int first_row = around.front().first_row;
  for (const GlossyRows& rows : around) {
    const std::size_t count = rows.pixels.size() / static_cast<std::size_t>(width);
    parallel_chunks(count, 1, [&](std::size_t begin, std::size_t) {
      const int row = rows.first_row - first_row + static_cast<int>(begin);
      for (int x = 0; x < width; ++x) {
        const std::size_t i = begin * width + x;
        const CoatRay& ray = rays[static_cast<std::size_t>(row) * width + x];
        if (ray.pdf == 0.0f && rows.pixels.coat_shares[i].coat <= 0.0f) {
          set_no_coat(coats_, row, x);
        } else {
          set_coat(coats_, row, x, lobe_of(rows.pixels, i), ray);
        }
      }
    });
  }
}

void RayReuse::reflect(const GlossySettings& settings, std::span<const GlossyRows> around,
                       const GlossyRows& band, std::span<const CoatRay> rays,
                       const MirroredLight& in_mirrors, CoatLight& reflected) {
  lay_out(settings, around, rays);
  const int width = settings.frame.width;
  const int first_row = around.front().first_row;
  const GBuffer& pixels = band.pixels;
  reflected.light.assign(pixels.size(), vec4(0.0f));
  reflected.guides.assign(settings.frame.denoise ? pixels.size() : 0, {vec3(0.0f), 0.0f, 0.0f});
  reflected.own.assign(settings.frame.coat_rays > 1 ? pixels.size() : 0, {vec3(0.0f), 0.0f});
  const bool keeps_mirrored = !in_mirrors.coats.empty();
  reflected.mirrored.assign(keeps_mirrored ? pixels.size() : 0, no_mirrored_coat());
  reflected.mirrored_bases.assign(keeps_mirrored ? pixels.size() : 0, no_shown_base());
  parallel_chunks(pixels.size() / width, 1, [&](std::size_t begin, std::size_t) {
    const int y = band.first_row + static_cast<int>(begin);
    SeenAround<CoatRay> seen{rays, first_row, {width, settings.frame.height}};
    SeenAround<MirroredCoat> coats_seen{
        in_mirrors.coats, first_row, {width, settings.frame.height}};
    std::vector<CoatReceiver> receivers;
    std::vector<int> places;
    RowPlanes asked, sums;
    asked.resize(kReceiverPlanes, width, 1);
    sums.resize(kSumPlanes, width, 1);
    for (int x = 0; x < width; ++x) {
      const std::size_t i = begin * width + x;
      if (pixels.coat_shares[i].coat <= 0.0f) continue;
      const CoatRay& own = rays[static_cast<std::size_t>(y - first_row) * width + x];
      receivers.push_back(receiver_of(settings, pixels, i, own));
      set_receiver(asked, 0, x, receivers.back());
      places.push_back(x);
    }
    if (receivers.empty()) return;
    const std::vector<NeighbourRow> neighbours = rows_around(settings, y, first_row);
    reuse_row({coats_, asked, y - first_row, 0, width, neighbours}, sums);
    for (std::size_t k = 0; k < receivers.size(); ++k) {
      const std::size_t i = begin * width + places[k];
      const float share = pixels.coat_shares[i].coat;
      const ReflectedRays found = reflected_rays(receivers[k], sums_of(sums, 0, places[k]));
      reflected.light[i] = share * light_by_rays(found.light);
      if (!reflected.own.empty()) reflected.own[i] = {found.own, share * found.own_share};
      if (keeps_mirrored) {
        const std::size_t place = static_cast<std::size_t>(y - first_row) * width + places[k];
        MirroredCoat& coat = reflected.mirrored[i];
        coat = mirrored_light(receivers[k], share, in_mirrors.coats[place]);
        reflected.mirrored_bases[i] = in_mirrors.bases[place];
        if (coat.alpha > 0.0f) {
          coat.inverse_seen_distance = coats_seen.seen_inverse_distance(
              coats_seen, {places[k], y}, static_cast<uint>(settings.sample), 1u);
        }
      }
      if (!settings.frame.denoise) continue;
      reflected.guides[i] = {
          share * found.excess,
          seen.seen_inverse_distance(seen, {places[k], y}, static_cast<uint>(settings.sample),
                                     static_cast<uint>(settings.frame.glossy_rows)),
          found.ray_variance};
    }
  });
}

}  // namespace lambent
