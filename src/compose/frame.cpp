// SPDX-License-Identifier: Apache-2.0
// The order of a frame, written once, and what a renderer keeps from frame to frame.
#include <algorithm>

#include "compose/check_frame.h"
#include "compose/frame_passes.h"
#include "lambent/world.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

std::unique_ptr<FramePasses> make_frame_passes(const World& world) {
#if LAMBENT_VULKAN
  if (const DeviceWorld* there = device_world_of(world)) return make_frame_passes_vulkan(*there);
#else
  static_cast<void>(world);  // no device can be opened
#endif
  return make_frame_passes_cpu();
}

void run_passes(const FrameRequest& request, bool makes_maps, const ProgressFn& progress,
                FramePasses& passes) {
  const FrameSettings& settings = request.settings;
  const IndirectSources& sources = request.sources;
  const Band all = rendered_rows(settings);
  const float share = 1.0f / static_cast<float>(settings.samples);
  const int band_rows = rows_of_a_band(settings.width);

  if (makes_maps) passes.rsm();
  for (int row = 0; row < all.rows; row += band_rows) {
    const Band band{all.first_row + row, std::min(band_rows, all.rows - row)};
    for (int sample = 0; sample < settings.samples; ++sample) {
      passes.gbuffer(band, sample);
      passes.direct();
      if (sources.field != nullptr) {
        passes.indirect();
        passes.glossy();
      }
      if (sources.rsm) passes.rsm_upsample();
      passes.compose(share);
      if (progress) {
        const double rows_done = row + band.rows * (sample + 1.0) / settings.samples;
        progress("frame", rows_done / all.rows);
      }
    }
  }
}

/// What a picture was rendered of.
struct PictureView {
  Camera camera;
  int width = 0, height = 0;
  std::uint64_t world_revision = 0;
};

bool is_same(const Camera& a, const Camera& b) {
  return a.world_from_view == b.world_from_view && a.orthographic == b.orthographic &&
         a.vertical_fov == b.vertical_fov && a.vertical_extent == b.vertical_extent;
}

bool is_same(const PictureView& a, const PictureView& b) {
  return is_same(a.camera, b.camera) && a.width == b.width && a.height == b.height &&
         a.world_revision == b.world_revision;
}

}  // namespace

struct Renderer::State {
  const World& world;
  IndirectSources sources;
  std::unique_ptr<FramePasses> passes;  // from the first frame on
  PictureView last;                     // of the frame before, where there are passes
  std::uint64_t frames = 0;
};

Renderer::Renderer(const World& world, const IndirectSources& sources)
    : state_(new State{world, sources, nullptr, {}, 0}) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Expected<void> Renderer::render(const Camera& camera, const FrameSettings& settings,
                                RenderedFrame& frame, const ProgressFn& progress) {
  State& s = *state_;
  const FrameRequest request{s.world, s.sources, camera, settings};
  if (const Expected<void> fine = check(request); !fine) return fine;

  // Rows below the first continue the picture before, whose maps are as they would be made again
  const PictureView view{camera, settings.width, settings.height, s.world.revision()};
  const bool continues = settings.first_row > 0 && s.passes != nullptr && is_same(view, s.last);
  if (s.passes == nullptr) s.passes = make_frame_passes(s.world);
  try {
    s.passes->begin(request, frame);
    run_passes(request, s.sources.rsm && !continues, progress, *s.passes);
    s.passes->finish();
  } catch (...) {
    s.passes.reset();  // half a frame is no start for the next one
    throw;
  }
  s.last = view;
  ++s.frames;
  return {};
}

Expected<RenderedFrame> Renderer::render(const Camera& camera, const FrameSettings& settings,
                                         const ProgressFn& progress) {
  RenderedFrame frame;
  if (const Expected<void> done = render(camera, settings, frame, progress); !done) {
    return tl::unexpected(done.error());
  }
  return frame;
}

std::uint64_t Renderer::frames() const {
  return state_->frames;
}

}  // namespace lambent
