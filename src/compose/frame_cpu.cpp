// SPDX-License-Identifier: Apache-2.0
// The passes of a frame on the processor.
#include <algorithm>
#include <optional>

#include "compose/accumulate.h"
#include "compose/adaptive/layers_so_far.h"
#include "compose/filter_frame.h"
#include "compose/fog/fog_frame.h"
#include "compose/frame_passes.h"
#include "compose/frame_tasks.h"
#include "compose/gather/guide_frame.h"
#include "compose/gather/shown_gather.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/history/light_history.h"
#include "compose/layers.h"
#include "compose/motion/motion.h"
#include "compose/pixel_math.h"
#include "compose/rsm/rsm_frame.h"
#include "core/image/exposure.h"
#include "core/parallel.h"
#include "core/pass_times.h"
#include "field/field_access.h"
#include "lambent/field.h"
#include "raytracing/camera_rays.h"

namespace lambent {
namespace {

constexpr std::size_t kFloatsPerTask = std::size_t{1} << 18;  // cleared by a task

/// Irradiance of the field at each pixel, on a surface that faces along normal(pixel). `queries` is
/// scratch memory. `use`: corrections have noise of their own, which would show again once gathered
/// light is filtered with the lookups, or another method's light is subtracted.
template <class Normal>
void look_up(const World& world, const IrradianceField& field, CorrectionUse use,
             const GBuffer& gbuffer, Normal normal, std::vector<FieldQuery>& queries,
             std::vector<vec3>& irradiance) {
  queries.resize(gbuffer.size());
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) {
        queries[i] = {};
        continue;
      }
      queries[i] = {gbuffer.surfaces[i].position_ws, normal(i), gbuffer.to_viewer_ws[i]};
    }
  });
  irradiance.resize(gbuffer.size());
  look_up_irradiance(field, queries, use, irradiance, world);
}

/// Gives an image a frame's layers, all zero.
void start_layers(const FrameSettings& settings, LayeredImage& image) {
  shape_layers(settings.width, rendered_rows(settings).rows, image);
  for (Layer& layer : image.layers) {
    std::vector<float>& pixels = layer.image.pixels;
    parallel_chunks(pixels.size(), kFloatsPerTask, [&](std::size_t begin, std::size_t end) {
      std::fill(pixels.data() + begin, pixels.data() + end, 0.0f);
    });
  }
}

class FramePassesCpu final : public FramePasses {
 public:
  void begin(const FrameRequest& request, RenderedFrame& frame) override {
    frame.passes.clear();
    frame.rays = 0;
    start_layers(request.settings, frame.image);
    if (wants_motion(request.settings)) {
      const int rows = traced_rows(request).rows;
      motion_.resize(static_cast<std::size_t>(frame.image.width) * static_cast<std::size_t>(rows));
    }
    if (!averages(request.settings)) history_.is_there = false;
    now_.emplace(request, frame);
  }

  void rsm() override {
    light_by_rsm(request(), rsm_);
    now_->frame.rays += rsm_.light.rays;
    now_->made_maps = true;
    finish_pass("rsm");
  }

  void gbuffer(const Band& band, int sample) override {
    band_ = band;
    sample_ = sample;
    now_->frame.rays += trace_gbuffer(request().world, request().camera, request().settings, band,
                                      sample, gbuffer_, request().jitter(), request().round);
    gbuffer_.coat_shares.clear();
    if (traces_coats(request())) find_coat_shares(gbuffer_);
    light_.transmitted.clear();
    finish_pass("gbuffer");
  }

  void motion() override {
    const FrameRequest& asked = request();
    now_->frame.rays += find_motion(asked, band_, sample_, gbuffer_, band_motion_);
    // A pixel's motion is that of its nearest sample
    const std::span<PixelMotion> pixels =
        std::span(motion_).subspan(first_pixel(), gbuffer_.size());
    parallel_chunks(pixels.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const PixelMotion& found = band_motion_[i];
        pixels[i] = sample_ == 0 ? found : nearer_motion(pixels[i], found);
      }
    });
    finish_pass("motion");
  }

  void direct() override {
    now_->frame.rays +=
        shade_direct(request().world, gbuffer_, request().settings, band_, drawn_sample(),
                     asks_lights_in_sub_images(request()), light_.direct);
    finish_pass("direct");
  }

  void rsm_direct() override {
    add_rsm_direct(rsm_, gbuffer_, request().camera, request().settings.width, band_,
                   light_.direct);
    finish_pass("rsm.direct_upsample");
  }

  void indirect() override {
    const World& world = request().world;
    const IndirectSources& sources = request().sources;
    const auto normal_at = [&](std::size_t i) { return gbuffer_.surfaces[i].normal_ws; };
    const CorrectionUse use = pixel_correction(request());
    look_up(world, *sources.field, use, gbuffer_, normal_at, queries_, light_.irradiance);
    if (sources.subtracted_field != nullptr) {
      look_up(world, *sources.subtracted_field, use, gbuffer_, normal_at, queries_, subtracted_);
    }
    finish_pass("indirect");
  }

  void guide() override {
    now_->frame.rays += guide_frame(request(), guide_);
    finish_pass("guide");
  }

  void gather() override {
    const FrameSettings& settings = request().settings;
    const GatherRequest asked{
        gbuffer_.surfaces,
        gbuffer_.hit,
        settings.width,
        band_.first_row,
        settings.gather_rays,
        static_cast<std::uint32_t>(drawn_sample()),
        settings.seed,
        settings.denoise ? std::span<const vec3>(light_.irradiance) : std::span<const vec3>(),
        guides_gathers(request()) ? &guide_ : nullptr};
    now_->frame.rays +=
        gather_irradiance(request().world, *request().sources.field, asked, gathered_);
    if (!settings.denoise) light_.irradiance.swap(gathered_.irradiance);
    finish_pass("gather");
  }

  void glossy() override {
    now_->frame.rays +=
        reflect_clearcoats(request(), band_, sample_, gbuffer_, light_.direct.sky_in_clearcoats,
                           glossy_, light_.clearcoats);
    now_->frame.rays += reflect_band(request(), band_, sample_, CoatKind::coat, gbuffer_,
                                     light_.direct.sky, glossy_, light_.coats);
    look_up_coats(request(), gbuffer_, light_.coats, glossy_, light_.mirror_irradiance);
    finish_pass("glossy");
  }

  void gather_in_mirrors() override {
    now_->frame.rays +=
        gather_shown(request(), band_, drawn_sample(), light_.coats.mirrored_bases, in_mirrors_);
    finish_pass("gather");
  }

  void transmission() override {
    KeptBehind kept;
    if (filters_through(request())) {
      kept = {&to_filter_.through, first_pixel()};
      kept.seen->start(request(), traced_pixels(request()), gbuffer_, kept.first);
    }
    now_->frame.rays +=
        look_through_band(request(), band_, sample_, gbuffer_, kept, glossy_, light_.transmitted);
    finish_pass("transmission");
  }

  void gather_behind_glass() override {
    now_->frame.rays +=
        gather_shown(request(), band_, drawn_sample(), light_.transmitted.bases, behind_glass_);
    finish_pass("gather");
  }

  void rsm_upsample() override {
    const bool alone = request().sources.field == nullptr;
    look_up_rsm(rsm_, gbuffer_, request().camera, request().settings.width, band_, from_maps_);
    if (alone) light_.irradiance.clear();
    replace_light(subtracted_, from_maps_, light_.irradiance);
    if (alone) {
      light_.mirror_irradiance = light_.irradiance;
      light_.coats.clear();
      light_.clearcoats.clear();
    }
    finish_pass("rsm.upsample");
  }

  void light_fog() override {
    const FrameRequest& asked = request();
    now_->frame.rays += fog_.find_light(fog_request(asked), asked.light_continues);
    finish_pass("fog");
  }

  void fog() override {
    find_fog(request(), fog_, band_, sample_, gbuffer_, light_.fog);
    finish_pass("fog");
  }

  void compose(float share) override {
    const FrameSettings& settings = request().settings;
    if (!has_fog(request())) light_.fog.clear();
    light_.has_indirect = request().sources.field != nullptr || request().sources.rsm;
    light_.looked_up = is_looked_up(request());
    light_.is_filtered = settings.denoise && gathers(request());
    light_.coats_are_filtered = settings.denoise && traces_coats(request());
    light_.transmitted_is_filtered = filters_through(request());
    accumulate(request().camera, gbuffer_, light_, shown_pixels(band_, settings), share,
               now_->layers);
    if (settings.denoise) {
      BandToFilter band{gbuffer_, light_.direct};
      band.fog = light_.fog;
      if (light_.coats_are_filtered) band.coats = &light_.coats;
      band.filters_clearcoats = filters_clearcoats(request());
      if (band.filters_clearcoats && !light_.clearcoats.empty()) {
        band.clearcoats = &glossy_.clearcoats;
      }
      if (gathers_in_mirrors(request())) band.in_mirrors = &in_mirrors_;
      if (gathers_behind_glass(request())) band.behind_glass = &behind_glass_;
      if (light_.is_filtered) band.gathered = &gathered_, band.looked_up = &light_.irradiance;
      if (light_.transmitted_is_filtered) band.transmitted = &light_.transmitted;
      keep_pixels(request(), band_, band, to_filter_);
    }
    finish_pass("compose");
  }

  void denoise(float share) override {
    if (averages(request().settings)) {
      average_light(request(), history_, to_filter_, next_history_);
      std::swap(history_, next_history_);
      finish_pass("history");
    }
    filter_pixels(request(), to_filter_);
    const FrameSettings& settings = request().settings;
    show_filtered(to_filter_, shown_pixels(traced_rows(request()), settings), share, now_->layers);
    finish_pass("denoise");
  }

  void read_luminances(std::vector<float>& luminances) override {
    lambent::read_luminances(now_->frame.image, luminances);
  }

  float exposure() override { return display_stops(now_->frame.image); }

  void refine(const FrameRequest& request, float kept) override {
    now_->request = &request;
    scale_layers(request.round.skipped, kept, now_->frame.image);
  }

  void antialias() override {
    antialiasing_.resolve(request().sequence->frame(), motion_, *now_->frame.image.find(""));
    finish_pass("taa");
  }

  void finish() override {
    RenderedFrame& frame = now_->frame;
    if (request().settings.motion) {
      const FrameSettings& settings = request().settings;
      const ShownPixels shown = shown_pixels(traced_rows(request()), settings);
      frame.image.layers.push_back(
          motion_layer(frame.image.width, frame.image.height,
                       std::span(motion_).subspan(shown.first, shown.count)));
    }
    if (now_->made_maps) {
      for (Layer& layer : rsm_.layers) frame.image.layers.push_back(std::move(layer));
      frame.passes.insert(frame.passes.end(), rsm_.light.passes.begin(), rsm_.light.passes.end());
    }
    now_.reset();
  }

 private:
  /// The frame being rendered.
  struct Now {
    Now(const FrameRequest& asked, RenderedFrame& made)
        : request(&asked), frame(made), timer(made.passes), layers(made.image) {}
    const FrameRequest* request;
    RenderedFrame& frame;
    PassTimer timer;
    Layers layers;
    bool made_maps = false;
  };

  const FrameRequest& request() const { return *now_->request; }
  int drawn_sample() const { return request().drawn(sample_); }
  /// First pixel of the band among the traced pixels.
  std::size_t first_pixel() const {
    const FrameSettings& settings = request().settings;
    const int first_row = band_.first_row - traced_rows(request()).first_row;
    return static_cast<std::size_t>(first_row) * settings.width;
  }
  void finish_pass(const char* name) { now_->timer.finish(name); }

  std::optional<Now> now_;
  Band band_;
  int sample_ = 0;

  // Reused from frame to frame: the memory of a band's pixels, of the maps and their light, and of
  // the motion of all rendered pixels
  RsmFrame rsm_;
  GBuffer gbuffer_;
  std::vector<PixelMotion> band_motion_, motion_;
  TemporalAntialiasing antialiasing_;
  BandLight light_;
  GatherGuide guide_;
  GatheredLight gathered_;
  ShownGather in_mirrors_, behind_glass_;
  FilteredPixels to_filter_;
  LightHistory history_, next_history_;  // of the previous frame, and of this one
  std::vector<FieldQuery> queries_;
  std::vector<vec3> subtracted_, from_maps_;
  GlossyMemory glossy_;
  FroxelFog fog_;
};

}  // namespace

std::unique_ptr<FramePasses> make_frame_passes_cpu() {
  return std::make_unique<FramePassesCpu>();
}

}  // namespace lambent
