// SPDX-License-Identifier: Apache-2.0
// The memory of a frame's passes on a Vulkan device.
#pragma once

#include <array>

#include "compose/filter_records.h"
#include "compose/glossy/seen_through_records.h"
#include "denoise/denoise_vulkan.h"
#include "field/secondary/secondary_math.h"
#include "fog/fog.h"
#include "glossy/glossy_records.h"
#include "raytracing/vulkan/hit_shading.h"
#include "rsm/vulkan/direct_vulkan.h"
#include "rsm/vulkan/gather_vulkan.h"
#include "temporal/taa_vulkan.h"
#include "vulkan/buffer.h"

namespace lambent {

/// Memory of a ShownGatherRecord: 76 bytes for each pixel of the traced rows; and the irradiance by
/// lookups at a band's pixels.
struct ShownGatherBuffers {
  vulkan::Buffer geometric_normals_ws, gathered, variance, excess, looked_up, albedo, filtered;
  vulkan::Buffer band_lookups;
};

/// Light that is filtered, of the traced rows: 400 bytes a pixel, 168 more where mirrors may show
/// coats and light of emitters, and 76 more where what they show gathers light. See
/// FilteredPixelsRecord.
struct FilteredBuffers {
  FilteredPixelsRecord record;
  vulkan::Buffer addresses;  ///< Holds `record`.
  vulkan::Buffer positions_ws, normals_ws, geometric_normals_ws, depths;
  vulkan::Buffer gathered, gathered_variance, excess, looked_up, indirect_albedo, received_weight;
  vulkan::Buffer emitters, emitter_variance, emitter_albedo, emitter_levels;
  vulkan::Buffer coats, coat_excess, coat_variance, coat_albedo, coat_lobes;
  vulkan::Buffer clearcoats, clearcoat_excess, clearcoat_variance, clearcoat_albedo;
  vulkan::Buffer clearcoat_normals_ws, clearcoat_lobes;
  vulkan::Buffer highlights, highlight_albedo, highlight_lobes;
  vulkan::Buffer filtered_gathered, filtered_emitters, filtered_coats, filtered_highlights;
  vulkan::Buffer filtered_clearcoats;
  vulkan::Buffer mirrored, mirrored_albedo, mirrored_positions_ws, mirrored_normals_ws;
  vulkan::Buffer mirrored_depths, mirrored_lobes, filtered_mirrored;
  vulkan::Buffer mirrored_emitters, mirrored_emitter_variance, mirrored_emitter_levels;
  vulkan::Buffer mirrored_emitter_albedo, mirrored_base_positions_ws;
  vulkan::Buffer mirrored_base_normals_ws, mirrored_base_depths, filtered_mirrored_emitters;
  ShownGatherBuffers mirrored_gather;
};

/// Light seen through surfaces, which is filtered, of the traced rows: 216 bytes a pixel, and 76
/// more where what is behind gathers light.
struct SeenThroughBuffers {
  SeenThroughRecord record;
  vulkan::Buffer addresses;  ///< Holds `record`.
  vulkan::Buffer depths, positions_ws, normals_ws;
  vulkan::Buffer emitters, emitter_variance, emitter_levels, emitter_albedo;
  vulkan::Buffer coats, coat_albedo, coat_lobes, coat_distances;
  vulkan::Buffer light, albedo, lobes, distances;
  vulkan::Buffer filtered_emitters, filtered_coats, filtered;
  vulkan::Buffer long_ways, glass_depths, filtered_long_ways;
  vulkan::Buffer bases;  ///< Those of a band.
  ShownGatherBuffers gather;
};

/// Rays that gather light, their hits, and the field's irradiance there.
struct GatherBuffers {
  vulkan::Buffer rays, points, shaded, direct, field;
};

/// Memory of a PathList.
struct PathBuffers {
  vulkan::Buffer rays, cones, paths, pixels, count;

  PathList list() const {
    return {{rays.address()},
            {cones.address()},
            {paths.address()},
            {pixels.address()},
            {count.address()}};
  }
};

/// Memory that a renderer reuses from frame to frame. Buffers grow as frames need them to.
struct FrameMemory {
  explicit FrameMemory(const vulkan::Device& device)
      : pixel_shading(device),
        gather_shading(device),
        mapper(device),
        rsm(device),
        rsm_direct(device),
        denoiser(device),
        antialiasing(device) {}

  HitShading pixel_shading, gather_shading;
  RsmMapperVulkan mapper;
  RsmGathererVulkan rsm;
  RsmDirectVulkan rsm_direct;
  RsmMapsOnDevice maps;
  DenoiserVulkan denoiser;
  FilteredBuffers filtered;
  SeenThroughBuffers through;
  TaaVulkan antialiasing;

  // One entry for each pixel of a band
  vulkan::Buffer rays, cones, hits, points, surfaces, diffuse, specular;
  vulkan::Buffer queries, irradiance, mirror_irradiance, subtracted_field, from_maps;
  vulkan::Buffer gathered_variance, emitters, emitter_squares, emitter_specular;
  vulkan::Buffer sky, sky_in_clearcoats;
  // For the rays that gather the light of some pixels at a time, the secondary gathers at their
  // hits, those at the hits of these, and so on
  std::array<GatherBuffers, 1 + kMaxSecondaryRays> gathers;
  vulkan::Buffer gathering_weights, guided_rays, guide_points, guide_places;
  vulkan::Buffer gathered_hits, gathering_indices, secondary_indices, field_grids;
  // Positions, normals and depths of a band's pixels, and of the small view of reflective shadow
  // maps
  vulkan::Buffer band_geometry[3], small_geometry[3];
  // Motion of a band's pixels, and the rays that go on behind blended surfaces
  vulkan::Buffer motion, further_rays, further_hits, further_ray_count;
  // The scene of the previous frame
  vulkan::Buffer scene_before, instances_before, positions_before;
  // Pixels, rays and lists of paths, for the rows around a band whose coats are lit by rays.
  // Bounces use the two lists in turn
  vulkan::Buffer coats, coat_guides, coat_points, coat_surfaces, coat_rays, mirrored, own_rays;
  vulkan::Buffer mirrored_bases;
  // What the band's pixels show in mirrors or behind glass, and how many points gather light
  vulkan::Buffer shown_points, shown_surfaces, shown_queries, shown_points_found;
  PathBuffers path_lists[2];
  PathBuffers forks;  // branches, traced later
  vulkan::Buffer path_hits, path_points, path_surfaces, path_diffuse, path_specular;
  vulkan::Buffer path_queries, path_answers;
  vulkan::Buffer path_drawn, path_drawn_squares, path_drawn_specular, coat_distances;
  vulkan::Buffer path_sky;
  // Fog: its froxels, and its effect on a band's pixels
  FroxelFog fog;
  vulkan::Buffer media, froxels, fog_record, pixel_fog;
  // One entry for each pixel of the picture
  vulkan::Buffer layers, picture_motion, luminances, skipped;
};

}  // namespace lambent
