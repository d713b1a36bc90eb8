// SPDX-License-Identifier: Apache-2.0
// The order of a frame, written once.
#include <algorithm>
#include <cassert>

#include "compose/frame_passes.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "scene/validate.h"

namespace lambent {
namespace {

// Pixels rendered together: enough to keep all cores busy, few enough to stay small (about 50 MB).
constexpr int kBandPixels = 1 << 18;

std::unique_ptr<FramePasses> make_frame_passes(const FrameRequest& request) {
#if LAMBENT_VULKAN
  if (request.world.on_device() != nullptr) return make_frame_passes_vulkan(request);
#endif
  return make_frame_passes_cpu(request);
}

}  // namespace

RenderedFrame render_frame(const World& world, const IrradianceField* field, const Camera& camera,
                           const FrameSettings& settings, const ProgressFn& progress) {
  IndirectSources sources;
  sources.field = field;
  return render_frame(world, sources, camera, settings, progress);
}

RenderedFrame render_frame(const World& world, const IndirectSources& sources, const Camera& camera,
                           const FrameSettings& settings, const ProgressFn& progress) {
  assert(sources.rsm == nullptr || settings.gather_rays == 0);
  assert(settings.width > 0 && settings.height > 0 && settings.samples > 0);
  assert(flaw_of(camera) == nullptr);
  const std::unique_ptr<FramePasses> passes = make_frame_passes({world, sources, camera, settings});
  const Band all = rendered_rows(settings);
  assert(all.first_row >= 0 && all.rows > 0 && all.first_row + all.rows <= settings.height);
  assert(sources.rsm == nullptr || !sources.rsm_stages || all.rows == settings.height);
  const float share = 1.0f / static_cast<float>(settings.samples);
  const int band_rows = std::max(1, kBandPixels / settings.width);

  if (sources.rsm != nullptr) passes->rsm();
  for (int row = 0; row < all.rows; row += band_rows) {
    const Band band{all.first_row + row, std::min(band_rows, all.rows - row)};
    for (int sample = 0; sample < settings.samples; ++sample) {
      passes->gbuffer(band, sample);
      passes->direct();
      if (sources.field != nullptr) {
        passes->indirect();
        passes->glossy();
      }
      if (sources.rsm != nullptr) passes->rsm_upsample();
      passes->compose(share);
      if (progress) {
        const double rows_done = row + band.rows * (sample + 1.0) / settings.samples;
        progress("frame", rows_done / all.rows);
      }
    }
  }
  RenderedFrame frame;
  passes->finish(frame);
  return frame;
}

}  // namespace lambent
