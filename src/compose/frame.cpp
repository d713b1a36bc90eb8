// SPDX-License-Identifier: Apache-2.0
// The order of a frame, written once.
#include <algorithm>
#include <cassert>
#include <optional>

#include "compose/gbuffer.h"
#include "compose/rsm_frame.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "lambent/field.h"
#include "raytracing/camera_rays.h"
#include "scene/light_sampling.h"

namespace lambent {
namespace {

// Pixels rendered together: enough to keep all cores busy, few enough to stay small (about 50 MB).
constexpr int kBandPixels = 1 << 18;
constexpr std::size_t kPixelsPerTask = 4096;

/// The frame's layers, with quick access to each; all zero at the start.
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

/// Adds up the time of each pass over bands and samples.
class PassTimer {
 public:
  explicit PassTimer(std::vector<PassTime>& passes) : passes_(passes) {}

  /// Books the time since the last call on a pass.
  void finish(const char* name) {
    const double ms = watch_.lap();
    for (PassTime& pass : passes_) {
      if (pass.name == name) {
        pass.ms += ms;
        return;
      }
    }
    passes_.push_back({name, ms});
  }

 private:
  std::vector<PassTime>& passes_;
  Stopwatch watch_;
};

/// Irradiance of the field at each pixel, on a surface that faces along normal(pixel).
template <class Normal>
void look_up(const World& world, const IrradianceField& field, const GBuffer& gbuffer,
             Normal normal, std::vector<vec3>& irradiance) {
  std::vector<FieldQuery> queries(gbuffer.size());
  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      queries[i] = {gbuffer.surfaces[i].position_ws, normal(i), gbuffer.to_viewer_ws[i]};
    }
  });
  irradiance.resize(gbuffer.size());
  field.irradiance(queries, irradiance, &world);
}

/// Takes what another source brings out of the field's light, and adds that source's own.
void replace_light(const std::vector<vec3>& taken_out, const std::vector<vec3>& added,
                   std::vector<vec3>& irradiance) {
  irradiance.resize(std::max({irradiance.size(), taken_out.size(), added.size()}), vec3(0.0f));
  parallel_chunks(irradiance.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!added.empty()) irradiance[i] += added[i];
      if (!taken_out.empty()) irradiance[i] -= taken_out[i];
      irradiance[i] = max(irradiance[i], vec3(0.0f));
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
        indirect =
            reflectance.diffuse * (vec3(1.0f) - reflectance.f0) * light.irradiance[i] * kInvPi;
        const float n_dot_v = dot(surface.normal_ws, gbuffer.to_viewer_ws[i]);
        if (reflectance.f90 > 0.0f) {
          glossy += specular_albedo(reflectance, n_dot_v) * light.mirror_irradiance[i] * kInvPi;
        }
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
      layers.depth.data[pixel] += share * view_depth(camera, surface.position_ws);
    }
  });
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
  const IrradianceField* field = sources.field;
  assert(sources.rsm == nullptr || settings.gather_rays == 0);
  assert(settings.width > 0 && settings.height > 0 && settings.samples > 0);
  RenderedFrame frame;
  frame.image.width = settings.width;
  frame.image.height = settings.height;
  Layers layers(frame.image);
  PassTimer timer(frame.passes);
  const float share = 1.0f / static_cast<float>(settings.samples);
  const int band_rows = std::max(1, kBandPixels / settings.width);

  std::optional<RsmFrame> rsm;
  if (sources.rsm != nullptr) {
    rsm = light_by_rsm(world, camera, settings, *sources.rsm, sources.rsm_stages);
    frame.rays += rsm->light.rays;
    timer.finish("rsm");
  }

  GBuffer gbuffer;
  BandLight light;
  std::vector<vec3> taken_out, from_maps;
  const auto normal_at = [&](std::size_t i) { return gbuffer.surfaces[i].normal_ws; };
  for (int row = 0; row < settings.height; row += band_rows) {
    const Band band{row, std::min(band_rows, settings.height - row)};
    for (int sample = 0; sample < settings.samples; ++sample) {
      trace_gbuffer(world, camera, settings, band, sample, gbuffer);
      timer.finish("gbuffer");
      frame.rays += gbuffer.size();

      frame.rays += shade_direct(world, gbuffer, settings, band, sample, light.direct);
      timer.finish("direct");

      if (field != nullptr) {
        if (settings.gather_rays > 0) {
          frame.rays +=
              gather_irradiance(world, *field, gbuffer, settings, band, sample, light.irradiance);
        } else {
          look_up(world, *field, gbuffer, normal_at, light.irradiance);
        }
        if (sources.taken_out != nullptr) {
          look_up(world, *sources.taken_out, gbuffer, normal_at, taken_out);
        }
        timer.finish("indirect");
        look_up(
            world, *field, gbuffer,
            [&](std::size_t i) {
              return reflect(-gbuffer.to_viewer_ws[i], gbuffer.surfaces[i].normal_ws);
            },
            light.mirror_irradiance);
        timer.finish("glossy");
      }

      if (rsm) {
        look_up_rsm(*rsm, gbuffer, camera, settings.width, band, from_maps);
        if (field == nullptr) light.irradiance.clear();
        replace_light(taken_out, from_maps, light.irradiance);
        if (field == nullptr) light.mirror_irradiance = light.irradiance;
        timer.finish("rsm.upsample");
      }

      accumulate(world, camera, gbuffer, light, static_cast<std::size_t>(row) * settings.width,
                 share, layers);
      timer.finish("compose");
      if (progress) {
        const double rows_done = row + band.rows * (sample + 1.0) / settings.samples;
        progress("frame", rows_done / settings.height);
      }
    }
  }
  if (rsm) {
    for (Layer& layer : rsm->layers) frame.image.layers.push_back(std::move(layer));
    frame.passes.insert(frame.passes.end(), rsm->light.passes.begin(), rsm->light.passes.end());
  }
  return frame;
}

}  // namespace lambent
