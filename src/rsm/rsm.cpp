// SPDX-License-Identifier: Apache-2.0
// Based on: Gruen and Bavoil, "Cache-efficient processor and method of rendering indirect
// illumination using interleaving and sub-image blur", US 9,129,443 B2, 2015. The order of the
// passes.
#include "lambent/rsm.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "core/stopwatch.h"
#include "lambent/world.h"
#include "rsm/deinterleave.h"
#include "rsm/maps/lights.h"
#include "rsm/maps/map.h"
#include "rsm/mosaic.h"
#include "rsm/order.h"
#include "rsm/passes.h"

namespace lambent {
namespace {

constexpr int kMaxResolution = 4096, kMaxTexels = 65536, kMaxSubImages = 16, kMaxBlurRadius = 4;
constexpr int kMaxVisibilityRays = 64, kMaxDownscale = 16, kMaxDirectLights = 65536;
constexpr float kMaxDiskRadius = 2.0f, kMinSoftening = 0.01f, kMaxSoftening = 100.0f;

// Distances of the taps of the irregular blur [pixels of a sub-image]: farther than the regular
// blur's, and without a common divisor, so that they are not in step with a pattern.
constexpr int kIrregularDistances[] = {2, 5, 7};

/// Fails where a value is not in [low, high]; written so that a NaN fails, too.
template <class T>
Expected<void> within(const char* name, T value, T low, T high) {
  if (value >= low && value <= high) return {};
  // Avoid to_string, which writes small numbers as zeros
  std::ostringstream cause;
  cause << value << " is not ";
  if (low == std::numeric_limits<T>::min()) {
    cause << "above 0, up to " << high;
  } else {
    cause << "between " << low << " and " << high;
  }
  return fail("", name, cause.str());
}

Expected<void> check_view(const RsmView& view) {
  if (view.width <= 0 || view.height <= 0) return fail("", "view", "has no pixels");
  const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
  if (view.positions_ws.size() != pixels || view.normals_ws.size() != pixels ||
      view.depths.size() != pixels) {
    return fail("", "view", "needs a position, a normal and a depth for each of its pixels");
  }
  return {};
}

std::vector<BlurTap> irregular_taps() {
  std::vector<BlurTap> taps;
  for (const int distance : kIrregularDistances) taps.push_back({distance, 1.0f});
  return taps;
}

bool blurs_picture(const RsmSettings& settings) {
  return settings.final_blur && settings.sub_images > 1;
}

Layer layer_of(const char* name, std::span<const glm::vec3> pixels, int width, int height) {
  Layer layer{name, Image(width, height, 3)};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) layer.image.pixels[3 * i + c] = pixels[i][c];
  }
  return layer;
}

/// A layer of all sub-images side by side.
Layer mosaic_layer(std::span<const glm::vec3> interleaved, int width, int height, int sub_images) {
  Layer layer{"rsm.mosaic", Image(width, height, 3)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::ivec2 sub = sub_image_of({x, y}, sub_images);
      const glm::ivec2 place = place_in_sub_image({x, y}, sub_images);
      float* to = layer.image.at(sub_image_start(width, sub.x, sub_images) + place.x,
                                 sub_image_start(height, sub.y, sub_images) + place.y);
      const glm::vec3& from = interleaved[static_cast<std::size_t>(y) * width + x];
      for (int c = 0; c < 3; ++c) to[c] = from[c];
    }
  }
  return layer;
}

/// The passes on the processor.
class PassesOnHost final : public RsmPasses {
 public:
  PassesOnHost(const World& world, const RsmView& view, std::size_t maps, const FetchMap& fetch,
               const RsmLights& lights, const RsmSettings& settings, Mosaic& mosaic,
               RsmIrradiance& result)
      : world_(world),
        view_(view),
        maps_(maps),
        fetch_(fetch),
        lights_(lights),
        settings_(settings),
        mosaic_(mosaic),
        result_(result) {}

  void begin(const char* name) override {
    name_ = name;
    watch_.lap();
  }
  void end() override { result_.passes.push_back({name_, watch_.lap()}); }
  void gather() override {
    if (settings_.pattern == RsmPattern::whole) {
      result_.rays = gather_whole(world_, view_, lights_, settings_, mosaic_);
    } else {
      gather_disks(view_, maps_, fetch_, settings_, mosaic_);
    }
  }
  void blur_sub_images(std::span<const BlurTap> taps) override {
    lambent::blur_sub_images(taps, settings_, mosaic_);
  }
  void interleave(std::span<const BlurTap> taps) override {
    lambent::interleave(taps, settings_, mosaic_, result_.irradiance);
  }
  void keep(RsmStage stage) override {
    if (stage != RsmStage::blurred) interleave({});
    add_stage_layers(stage, result_.irradiance, settings_, result_);
  }

 private:
  const World& world_;
  const RsmView& view_;
  std::size_t maps_;
  const FetchMap& fetch_;
  const RsmLights& lights_;
  const RsmSettings& settings_;
  Mosaic& mosaic_;
  RsmIrradiance& result_;
  Stopwatch watch_;
  const char* name_ = "";
};

}  // namespace

int blur_reach(const RsmSettings& settings) {
  const int irregular = settings.irregular_blur ? kIrregularDistances[2] : 0;
  const int sub_reach = settings.sub_images * std::max(settings.sub_blur_radius, irregular);
  return std::max(sub_reach, settings.final_blur ? settings.sub_images / 2 : 0);
}

void add_stage_layers(RsmStage stage, std::span<const glm::vec3> picture,
                      const RsmSettings& settings, RsmIrradiance& result) {
  constexpr const char* kNames[kRsmStages] = {"rsm.gathered", "rsm.interleaved", "rsm.blurred"};
  const int width = result.width, height = result.height;
  result.stages.push_back(layer_of(kNames[static_cast<int>(stage)], picture, width, height));
  if (stage != RsmStage::gathered) return;
  result.stages.push_back(mosaic_layer(picture, width, height, settings.sub_images));
}

void run_rsm_passes(const RsmSettings& settings, bool keep_stages, RsmPasses& passes) {
  passes.begin("rsm.gather");
  passes.gather();
  passes.end();
  if (keep_stages) passes.keep(RsmStage::gathered);

  passes.begin("rsm.sub_blur");
  if (settings.sub_blur_radius > 0) passes.blur_sub_images(box_taps(settings.sub_blur_radius));
  if (settings.irregular_blur) passes.blur_sub_images(irregular_taps());
  passes.end();
  if (keep_stages) passes.keep(RsmStage::interleaved);

  passes.begin("rsm.interleave");
  const bool blur = blurs_picture(settings);
  passes.interleave(blur ? period_taps(settings.sub_images) : std::vector<BlurTap>());
  passes.end();
  if (keep_stages) passes.keep(RsmStage::blurred);
}

struct RsmGatherer::Buffers {
  Mosaic mosaic;
  ReflectiveShadowMap map;  // the map being read, where maps are rendered one at a time

  /// Settings and view must be in range.
  void gather(const World& world, std::size_t maps, const FetchMap& fetch, const RsmView& view,
              const RsmSettings& settings, RsmIrradiance& result, bool keep_stages);
};

RsmGatherer::RsmGatherer() : buffers_(std::make_unique<Buffers>()) {}
RsmGatherer::~RsmGatherer() = default;
RsmGatherer::RsmGatherer(RsmGatherer&&) noexcept = default;
RsmGatherer& RsmGatherer::operator=(RsmGatherer&&) noexcept = default;

Expected<void> check(const RsmSettings& s) {
  const Expected<void> checks[] = {
      within("resolution", s.resolution, 1, kMaxResolution),
      within("texels", s.texels, 0, kMaxTexels),
      within("sub_maps", s.sub_maps, 1, kMaxSubImages),
      within("sub_images", s.sub_images, 1, kMaxSubImages),
      within("disk_radius", s.disk_radius, std::numeric_limits<float>::min(), kMaxDiskRadius),
      within("softening", s.softening, kMinSoftening, kMaxSoftening),
      within("sub_blur_radius", s.sub_blur_radius, 0, kMaxBlurRadius),
      within("plane_tolerance", s.plane_tolerance, std::numeric_limits<float>::min(), 1.0f),
      within("visibility_rays", s.visibility_rays, 0, kMaxVisibilityRays),
      within("downscale", s.downscale, 1, kMaxDownscale),
      within("direct_lights", s.direct_lights, 0, kMaxDirectLights)};
  for (const Expected<void>& fine : checks) {
    if (!fine) return fine;
  }
  if (s.sub_images % s.sub_maps != 0) {
    return fail("", "sub_images",
                std::to_string(s.sub_images) + " is not a multiple of sub_maps, " +
                    std::to_string(s.sub_maps) + ": some light would reach no pixel");
  }
  if (s.pattern == RsmPattern::disk && s.texels == 0) {
    return fail("", "texels", "a disk needs a number of samples, not 0");
  }
  if (s.pattern == RsmPattern::disk && s.visibility_rays > 0) {
    return fail("", "visibility_rays", "go with RsmPattern::whole alone");
  }
  if (s.merge_maps && (s.pattern != RsmPattern::whole || s.texels == 0)) {
    return fail("", "merge_maps", "goes with RsmPattern::whole and a number of texels alone");
  }
  if (s.direct && s.from_camera) {
    return fail("", "direct", "is of lights' own maps, and does not go with from_camera");
  }
  if (s.direct_lights > 0 && !s.direct) return fail("", "direct_lights", "go with direct alone");
  return {};
}

bool blurs(const RsmSettings& settings) {
  return settings.sub_blur_radius > 0 || settings.irregular_blur || blurs_picture(settings);
}

void RsmGatherer::Buffers::gather(const World& world, std::size_t maps, const FetchMap& fetch,
                                  const RsmView& view, const RsmSettings& settings,
                                  RsmIrradiance& result, bool keep_stages) {
  const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
  result.width = view.width;
  result.height = view.height;
  result.irradiance.resize(pixels);
  result.passes.clear();
  result.stages.clear();
  result.rays = 0;

  // Choose the lights and lay them out in the order in which they will be read
  Stopwatch watch;
  const bool whole = settings.pattern == RsmPattern::whole;
  const RsmLights lights = whole ? choose_lights(maps, fetch, view, settings) : RsmLights();
  result.passes.push_back({"rsm.choose", watch.lap()});
  const bool restructured = settings.layout == RsmLayout::restructured;
  mosaic.reshape(view.width, view.height, restructured ? settings.sub_images : 1,
                 blur_reach(settings));
  PassesOnHost passes(world, view, maps, fetch, lights, settings, mosaic, result);
  run_rsm_passes(settings, keep_stages, passes);
}

Expected<void> RsmGatherer::gather(const World& world, std::span<const ReflectiveShadowMap> maps,
                                   const RsmView& view, const RsmSettings& settings,
                                   RsmIrradiance& result, bool keep_stages) {
  if (const Expected<void> fine = check(settings); !fine) return fine;
  if (const Expected<void> fine = check_view(view); !fine) return fine;
  const auto fetch = [&](std::size_t m) -> const ReflectiveShadowMap& { return maps[m]; };
  buffers_->gather(world, maps.size(), fetch, view, settings, result, keep_stages);
  return {};
}

Expected<void> RsmGatherer::gather(const World& world, const Camera& camera, float aspect,
                                   const RsmView& view, const RsmSettings& settings,
                                   RsmIrradiance& result, bool keep_stages) {
  if (const Expected<void> fine = check_map_request(camera, aspect, settings); !fine) return fine;
  if (const Expected<void> fine = check_view(view); !fine) return fine;
  double map_ms = 0.0;
  const auto fetch = [&](std::size_t m) -> const ReflectiveShadowMap& {
    Stopwatch watch;
    ReflectiveShadowMap& map = buffers_->map;
    if (settings.from_camera) {
      render_rsm(world, camera, aspect, settings, map);
    } else {
      render_rsm(world, world.scene().lights[m], settings, map);
    }
    map_ms += watch.lap();
    return map;
  };
  const std::size_t maps = settings.from_camera ? 1 : world.scene().lights.size();
  buffers_->gather(world, maps, fetch, view, settings, result, keep_stages);

  // Maps are rendered within the pass that chooses texels, or that gathers
  const char* within = settings.pattern == RsmPattern::whole ? "rsm.choose" : "rsm.gather";
  for (PassTime& pass : result.passes) {
    if (pass.name == within) pass.ms -= map_ms;
  }
  result.passes.insert(result.passes.begin(), {"rsm.map", map_ms});
  return {};
}

}  // namespace lambent
