// SPDX-License-Identifier: Apache-2.0
// The passes of a frame on the processor.
#include <algorithm>
#include <optional>

#include "compose/frame_passes.h"
#include "compose/layers.h"
#include "compose/pixel_math.h"
#include "compose/rsm_frame.h"
#include "core/parallel.h"
#include "core/pass_times.h"
#include "lambent/field.h"
#include "raytracing/camera_rays.h"
#include "scene/environment_sampling.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;
constexpr std::size_t kFloatsPerTask = std::size_t{1} << 18;  // to clear

/// The frame's layers, with quick access to each.
struct Layers {
  explicit Layers(LayeredImage& image)
      : all(image, "", 3),
        direct(image, "direct", 3),
        indirect(image, "indirect", 3),
        irradiance(image, "irradiance", 3),
        glossy(image, "glossy", 3),
        emission(image, "emission", 3),
        albedo(image, "albedo", 3),
        normal(image, "normal", 3),
        position(image, "position", 3),
        depth(image, "depth", 1) {}

  /// A layer's floats. They stay where they are when further layers are made.
  struct Pixels {
    Pixels(LayeredImage& image, const char* name, int channels)
        : data(image.require(name, channels).pixels.data()) {}
    float* data;
  };
  Pixels all, direct, indirect, irradiance, glossy, emission, albedo, normal, position, depth;
};

void add(Layers::Pixels& layer, std::size_t pixel, const vec3& value) {
  for (int c = 0; c < 3; ++c) layer.data[3 * pixel + c] += value[c];
}

/// Irradiance of the field at each pixel, on a surface that faces along normal(pixel); `queries` is
/// memory to ask in.
template <class Normal>
void look_up(const World& world, const IrradianceField& field, const GBuffer& gbuffer,
             Normal normal, std::vector<FieldQuery>& queries, std::vector<vec3>& irradiance) {
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
  field.irradiance(queries, irradiance, &world);
}

/// Takes what another source brings out of the field's light, and adds that source's own.
void replace_light(const std::vector<vec3>& subtracted_field, const std::vector<vec3>& added,
                   std::vector<vec3>& irradiance) {
  irradiance.resize(added.size(), vec3(0.0f));
  parallel_chunks(irradiance.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      irradiance[i] = replaced_light(irradiance[i], added[i],
                                     subtracted_field.empty() ? vec3(0.0f) : subtracted_field[i]);
    }
  });
}

/// Everything that one sample of one band brings.
struct BandLight {
  ReflectedLight direct;
  std::vector<vec3> irradiance;         // indirect, on the surface
  std::vector<vec3> mirror_irradiance;  // indirect, on a surface that faces the mirror direction
};

/// Adds a band's sample to the layers, each pixel with weight `share`.
void accumulate(const World& world, const Camera& camera, const GBuffer& gbuffer,
                const BandLight& light, std::size_t first_pixel, float share, Layers& layers) {
  const bool has_field = !light.irradiance.empty();
  const CameraRecord record = camera_record(camera, 1, 1);
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t pixel = first_pixel + i;
      if (gbuffer.hit[i] == 0) {
        const vec3 sky = sky_radiance(world.scene().environment, -gbuffer.to_viewer_ws[i]);
        add(layers.emission, pixel, share * sky);
        add(layers.all, pixel, share * sky);
        continue;
      }
      const Surface& surface = gbuffer.surfaces[i];
      const Reflectance& reflectance = surface.reflectance;

      // Reflect the field's light: the base under the coat, and the coat by its directional albedo
      vec3 indirect(0.0f), glossy = light.direct.specular[i];
      if (has_field && surface.receives_gi) {
        indirect = reflected_indirect(reflectance, light.irradiance[i]);
        glossy += reflected_glossy(reflectance, dot(surface.normal_ws, gbuffer.to_viewer_ws[i]),
                                   light.mirror_irradiance[i]);
        add(layers.irradiance, pixel, share * light.irradiance[i]);
      }

      add(layers.direct, pixel, share * light.direct.diffuse[i]);
      add(layers.indirect, pixel, share * indirect);
      add(layers.glossy, pixel, share * glossy);
      add(layers.emission, pixel, share * surface.emission);
      add(layers.all, pixel,
          share * (light.direct.diffuse[i] + indirect + glossy + surface.emission));
      add(layers.albedo, pixel, share * reflectance.diffuse);
      add(layers.normal, pixel, share * surface.normal_ws);
      add(layers.position, pixel, share * surface.position_ws);
      layers.depth.data[pixel] += share * view_depth(record, surface.position_ws);
    }
  });
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
    trace_gbuffer(request().world, request().camera, request().settings, band, sample, gbuffer_);
    now_->frame.rays += gbuffer_.size();
    finish_pass("gbuffer");
  }

  void direct() override {
    now_->frame.rays +=
        shade_direct(request().world, gbuffer_, request().settings, band_, sample_, light_.direct);
    finish_pass("direct");
  }

  void indirect() override {
    const World& world = request().world;
    const FrameSettings& settings = request().settings;
    const IndirectSources& sources = request().sources;
    const auto normal_at = [&](std::size_t i) { return gbuffer_.surfaces[i].normal_ws; };
    if (settings.gather_rays > 0) {
      now_->frame.rays += gather_irradiance(world, *sources.field, gbuffer_, settings, band_,
                                            sample_, light_.irradiance);
    } else {
      look_up(world, *sources.field, gbuffer_, normal_at, queries_, light_.irradiance);
    }
    if (sources.subtracted_field != nullptr) {
      look_up(world, *sources.subtracted_field, gbuffer_, normal_at, queries_, subtracted_);
    }
    finish_pass("indirect");
  }

  void glossy() override {
    const auto mirrored_at = [&](std::size_t i) {
      return reflect(-gbuffer_.to_viewer_ws[i], gbuffer_.surfaces[i].normal_ws);
    };
    look_up(request().world, *request().sources.field, gbuffer_, mirrored_at, queries_,
            light_.mirror_irradiance);
    finish_pass("glossy");
  }

  void rsm_upsample() override {
    const bool alone = request().sources.field == nullptr;
    look_up_rsm(rsm_, gbuffer_, request().camera, request().settings.width, band_, from_maps_);
    if (alone) light_.irradiance.clear();
    replace_light(subtracted_, from_maps_, light_.irradiance);
    if (alone) light_.mirror_irradiance = light_.irradiance;
    finish_pass("rsm.upsample");
  }

  void compose(float share) override {
    const FrameSettings& settings = request().settings;
    const int first_row = band_.first_row - rendered_rows(settings).first_row;
    const std::size_t first_pixel = static_cast<std::size_t>(first_row) * settings.width;
    accumulate(request().world, request().camera, gbuffer_, light_, first_pixel, share,
               now_->layers);
    finish_pass("compose");
  }

  void finish() override {
    RenderedFrame& frame = now_->frame;
    if (now_->made_maps) {
      for (Layer& layer : rsm_.layers) frame.image.layers.push_back(std::move(layer));
      frame.passes.insert(frame.passes.end(), rsm_.light.passes.begin(), rsm_.light.passes.end());
    }
    now_.reset();
  }

 private:
  /// The frame that is being made.
  struct Now {
    Now(const FrameRequest& asked, RenderedFrame& made)
        : request(asked), frame(made), timer(made.passes), layers(made.image) {}
    const FrameRequest& request;
    RenderedFrame& frame;
    PassTimer timer;
    Layers layers;
    bool made_maps = false;
  };

  const FrameRequest& request() const { return now_->request; }
  void finish_pass(const char* name) { now_->timer.finish(name); }

  std::optional<Now> now_;
  Band band_;
  int sample_ = 0;

  // From frame to frame; the memory of a band's pixels, and of the maps and their light
  RsmFrame rsm_;
  GBuffer gbuffer_;
  BandLight light_;
  std::vector<FieldQuery> queries_;
  std::vector<vec3> subtracted_, from_maps_;
};

}  // namespace

std::unique_ptr<FramePasses> make_frame_passes_cpu() {
  return std::make_unique<FramePassesCpu>();
}

}  // namespace lambent
