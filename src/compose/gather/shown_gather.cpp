// SPDX-License-Identifier: Apache-2.0
#include "compose/gather/shown_gather.h"

#include "compose/gather/excess.h"
#include "field/field_access.h"

namespace lambent {

std::uint64_t gather_shown(const FrameRequest& request, const Band& band, int sample,
                           std::span<const ShownBase> bases, ShownGather& found) {
  found.surfaces.resize(bases.size());
  found.seen.assign(bases.size(), 0);
  found.looked_up.assign(bases.size(), vec3(0.0f));
  found.asked.clear();
  found.queries.clear();
  for (std::size_t i = 0; i < bases.size(); ++i) {
    const ShownBase& base = bases[i];
    if (base.indirect_albedo == vec3(0.0f)) continue;
    Surface& surface = found.surfaces[i];
    surface.position_ws = base.position_ws;
    surface.normal_ws = base.normal_ws;
    surface.geometric_normal_ws = base.geometric_normal_ws;
    surface.gi_share = base.gi_share;
    found.seen[i] = 1;
    found.asked.push_back(i);
    found.queries.push_back(
        {base.position_ws, base.normal_ws, base.to_viewer_ws, base.viewer_distance});
  }
  const IrradianceField& field = *request.sources.field;
  found.answers.resize(found.queries.size());
  look_up_irradiance(field, found.queries, pixel_correction(request), found.answers, request.world);
  for (std::size_t k = 0; k < found.asked.size(); ++k) {
    found.looked_up[found.asked[k]] = found.answers[k];
  }
  const FrameSettings& settings = request.settings;
  const GatherRequest asked{found.surfaces,
                            found.seen,
                            settings.width,
                            band.first_row,
                            shown_gather_rays(settings),
                            static_cast<std::uint32_t>(sample),
                            settings.seed,
                            found.looked_up,
                            nullptr};
  return gather_irradiance(request.world, field, asked, found.light);
}

void ShownGatherPixels::resize(std::size_t pixels, bool has_variance) {
  for (std::vector<vec3>* vectors :
       {&geometric_normals_ws, &gathered, &excess, &looked_up, &albedo}) {
    vectors->resize(pixels);
  }
  variance.resize(has_variance ? pixels : 0);
}

void ShownGatherPixels::keep(const ShownGather& found, const ShownBase& base, const vec3& weight,
                             std::size_t i, std::size_t pixel) {
  geometric_normals_ws[pixel] = base.geometric_normal_ws;
  gathered[pixel] = found.light.irradiance[i];
  excess[pixel] = found.light.excess[i];
  looked_up[pixel] = base.gi_share * found.looked_up[i];
  if (!variance.empty()) variance[pixel] = found.light.variance[i];
  albedo[pixel] = weight * base.indirect_albedo;
}

void ShownGatherPixels::filter(DenoiseView view, Denoiser& denoiser) {
  filtered.resize(gathered.size());
  if (gathered.empty()) return;
  view.normals_ws = geometric_normals_ws;
  filter_gathered(view, {.light = gathered, .base = looked_up, .variance = variance}, excess,
                  denoiser, scratch_, filtered);
}

}  // namespace lambent
