// SPDX-License-Identifier: Apache-2.0
// An update of a field on the processor, pass by pass, with which a device's passes are compared.
#pragma once

#include <numeric>
#include <vector>

#include "field/lookup/lookup_volumes.h"
#include "field/probes/tile_fit.h"
#include "field/probes/tile_light.h"
#include "field/probes/volumes.h"
#include "field/transport/distances.h"
#include "field/transport/solve_bounces.h"
#include "field/vulkan/field_resources.h"
#include "raytracing/world_access.h"
#include "support/field_scenes.h"

namespace lambent::test {

inline std::vector<ProbeGrid> grids_for(const FieldSettings& settings, const Bounds& bounds) {
  std::vector<ProbeGrid> grids;
  const std::vector<Volume> volumes = plan_volumes(settings, bounds).value();
  for (const Volume& volume : volumes) grids.push_back(volume.grid);
  return grids;
}

struct UpdateOnCpu {
  /// Probes of even number trace the settings' rays, the others half as many.
  UpdateOnCpu(const Stage& stage_of, const FieldSettings& field_settings)
      : stage(stage_of),
        settings(field_settings),
        store(grids_for(settings, stage.bounds()), settings),
        before(store),
        fit(settings.irradiance_texels * settings.irradiance_texels,
            settings.irradiance_texels * settings.irradiance_texels,
            tile_fit_matrix(settings.irradiance_texels)),
        traces(store.probes()),
        all(store.probes()) {
    std::iota(all.begin(), all.end(), 0);
    for (int part = 0; part < 2; ++part) {
      TraceGroup group;
      group.rays = std::make_shared<RaySet>(settings, settings.rays_per_probe / (part + 1), 3u);
      for (int probe = part; probe < store.probes(); probe += 2) group.probes.push_back(probe);
      trace_probe_rays(tracer_of(stage.world), store, group);
      groups.push_back(std::move(group));
    }
    const SolidSides sides = solid_sides_by_winding(stage.scene);
    for (const TraceGroup& group : groups) {
      const DistanceBlend blend(settings, group.rays->directions);
      blend_distances(sides, blend, group, std::vector<float>(group.probes.size(), kShare), kSalt,
                      store);
      shade_surfels(stage.world, sides, store, group, settings, traces);
    }
    find_surfel_lookups(store, {}, all, traces);
  }

  TransportOperator transport() const {
    return {store.corner_table(), traces, all, fit, settings.irradiance_texels};
  }
  WorkingIrradiance darkness() const {
    return WorkingIrradiance(all.size() * tile_texels(), vec4(0.0f));
  }
  /// The irradiance from the sky, and from surfels that reflect direct light only.
  WorkingIrradiance direct_light() const {
    const WorkingIrradiance dark = darkness();
    WorkingIrradiance received = dark;
    transport().apply(dark, dark, received);
    return received;
  }
  std::size_t tile_texels() const {
    return static_cast<std::size_t>(settings.irradiance_texels) * settings.irradiance_texels;
  }

  static constexpr float kShare = 0.75f;
  static constexpr uint kSalt = 77u;

  const Stage& stage;
  FieldSettings settings;
  ProbeStore store, before;  // with the distances blended in, and without
  BlendMatrix fit;
  std::vector<TraceGroup> groups;
  std::vector<ProbeTrace> traces;
  std::vector<int> all;
};

inline FieldSettings few_probes() {
  FieldSettings settings;
  settings.probe_count = {5, 4, 4};
  settings.rays_per_probe = 72;
  return settings;
}

inline FieldSettings few_cascades() {
  FieldSettings settings;
  settings.cascades = 3;
  settings.probe_count = {4, 4, 4};
  settings.probe_spacing = 0.3f;
  settings.rays_per_probe = 48;
  return settings;
}

inline double relative_distance(WorkingIrradiance a, const WorkingIrradiance& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return norm(a) / norm(b);
}

}  // namespace lambent::test
