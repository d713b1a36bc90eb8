// SPDX-License-Identifier: Apache-2.0
#include "reference/path_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <mutex>
#include <string>

#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "raytracing/world_access.h"
#include "reference/path.h"
#include "reference/statistics.h"
#include "shared/color.h"

namespace lambent {
namespace {

using reference::PathIntegrator;
using reference::PixelSample;
using reference::SobolSampler;

constexpr int kTile = 16;  // pixels: small enough to balance, large enough to hide the scheduler
constexpr const char* kStage = "reference";

// The parts of a sample that become layers of pixel means.
struct LayerSource {
  const char* name;
  glm::vec3 PixelSample::*value;
  bool is_light;
};
constexpr std::array<LayerSource, 9> kLayers = {{
    {"direct", &PixelSample::direct, true},
    {"indirect", &PixelSample::indirect, true},
    {"irradiance", &PixelSample::irradiance, true},
    {"glossy", &PixelSample::glossy, true},
    {"transmission", &PixelSample::transmission, true},
    {"emission", &PixelSample::emission, true},
    {"fog", &PixelSample::fog, true},
    {"albedo", &PixelSample::albedo, false},
    {"normal", &PixelSample::normal, false},
}};

// The sums of a pixel over passes.
struct PixelStatistics {
  std::array<glm::dvec3, kLayers.size()> sums{};
  std::array<glm::dvec3, kLayers.size()> sums_of_squares{};  // of pass means, times samples
  glm::dvec3 radiance_sum_of_squares{0.0};
  glm::dvec3 radiance_sum{0.0};
};

class Renderer {
 public:
  Renderer(const World& world, const Camera& camera, const ReferenceSettings& settings)
      : world_(world),
        camera_(camera),
        settings_(settings),
        integrator_(world, settings.max_bounces, settings.strategy, settings.unlit_radiance),
        pixels_(static_cast<std::size_t>(settings.width) * settings.height) {}

  void render(const ProgressFn& progress);
  void write_layers(ReferenceResult& result) const;

 private:
  std::uint64_t sample_pixel(int x, int y, int pass, int samples);
  void write_first_hits(LayeredImage& image) const;
  double write_errors(LayeredImage& image) const;

  const World& world_;
  const Camera& camera_;
  const ReferenceSettings& settings_;
  PathIntegrator integrator_;
  std::vector<PixelStatistics> pixels_;
  int passes_ = 0;
  std::atomic<std::uint64_t> rays_ = 0;
};

// Adds `samples` paths of one pass to a pixel; returns the number of rays traced.
std::uint64_t Renderer::sample_pixel(int x, int y, int pass, int samples) {
  const std::size_t index = static_cast<std::size_t>(y) * settings_.width + x;
  const uvec3 seed = hash_pcg3d(
      uvec3(static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(pass), settings_.seed));
  std::array<glm::dvec3, kLayers.size()> sums{};
  std::uint64_t rays = 0;
  for (int s = 0; s < samples; ++s) {
    SobolSampler random(seed.x, static_cast<std::uint32_t>(s));
    const glm::vec2 offset = random.next2();
    const Ray ray = camera_ray(camera_, settings_.width, settings_.height,
                               static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y);
    const PixelSample sample = integrator_.sample_pixel(ray, random, rays);
    for (std::size_t l = 0; l < kLayers.size(); ++l) sums[l] += sample.*kLayers[l].value;
  }

  PixelStatistics& pixel = pixels_[index];
  glm::dvec3 radiance(0.0);
  for (std::size_t l = 0; l < kLayers.size(); ++l) {
    pixel.sums[l] += sums[l];
    pixel.sums_of_squares[l] += sums[l] * sums[l] / static_cast<double>(samples);
    if (kLayers[l].is_light && kLayers[l].value != &PixelSample::irradiance) radiance += sums[l];
  }
  pixel.radiance_sum += radiance;
  pixel.radiance_sum_of_squares += radiance * radiance / static_cast<double>(samples);
  return rays;
}

void Renderer::render(const ProgressFn& progress) {
  std::mutex progress_mutex;
  std::size_t pixels_done = 0;
  const double pixels_in_all =
      static_cast<double>(pixels_.size()) * reference::pass_count(settings_.samples);
  passes_ = reference::pass_count(settings_.samples);
  const int tile_columns = (settings_.width + kTile - 1) / kTile;
  const int tile_rows = (settings_.height + kTile - 1) / kTile;
  for (int pass = 0; pass < passes_; ++pass) {
    const int samples = reference::samples_of_pass(settings_.samples, pass);
    const auto render_tile = [&](std::size_t tile, std::size_t) {
      const int left = static_cast<int>(tile % tile_columns) * kTile;
      const int top = static_cast<int>(tile / tile_columns) * kTile;
      const int right = std::min(left + kTile, settings_.width);
      const int bottom = std::min(top + kTile, settings_.height);
      std::uint64_t rays = 0;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) rays += sample_pixel(x, y, pass, samples);
      }
      rays_ += rays;
      if (!progress) return;
      const std::lock_guard lock(progress_mutex);
      pixels_done += static_cast<std::size_t>(bottom - top) * (right - left);
      progress(kStage, static_cast<double>(pixels_done) / pixels_in_all);
    };
    parallel_chunks(static_cast<std::size_t>(tile_columns) * tile_rows, 1, render_tile);
  }
}

void put(Image& image, std::size_t pixel, const glm::dvec3& value) {
  for (int k = 0; k < 3; ++k) image.pixels[pixel * 3 + k] = static_cast<float>(value[k]);
}

void Renderer::write_first_hits(LayeredImage& image) const {
  Image& position = image.require("position", 3);
  Image& depth = image.require("depth", 1);
  for (int y = 0; y < settings_.height; ++y) {
    for (int x = 0; x < settings_.width; ++x) {
      const Ray ray = camera_ray(camera_, settings_.width, settings_.height,
                                 static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Hit hit = tracer_of(world_).closest_hit(ray);
      if (hit.missed()) continue;
      const glm::vec3 p = ray.origin + hit.distance * ray.direction;
      std::copy_n(&p.x, 3, position.at(x, y));
      *depth.at(x, y) = view_depth(camera_, p);
    }
  }
}

// Writes "error" and, if requested, "NAME.error"; returns the relative standard error of the total.
double Renderer::write_errors(LayeredImage& image) const {
  Image& error = image.require("error", 3);
  double squared_error = 0.0;
  double mean = 0.0;
  for (std::size_t p = 0; p < pixels_.size(); ++p) {
    const PixelStatistics& pixel = pixels_[p];
    const glm::dvec3 variance = reference::variance_of_mean(
        pixel.radiance_sum, pixel.radiance_sum_of_squares, settings_.samples, passes_);
    put(error, p, glm::sqrt(variance));
    const double se = luminance(glm::vec3(glm::sqrt(variance)));
    squared_error += se * se;
    mean += luminance(glm::vec3(pixel.radiance_sum / static_cast<double>(settings_.samples)));
  }
  for (std::size_t l = 0; settings_.layer_errors && l < kLayers.size(); ++l) {
    if (!kLayers[l].is_light) continue;
    Image& layer = image.require(std::string(kLayers[l].name) + ".error", 3);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      put(layer, p,
          glm::sqrt(reference::variance_of_mean(pixels_[p].sums[l], pixels_[p].sums_of_squares[l],
                                                settings_.samples, passes_)));
    }
  }
  if (passes_ < 2) return std::numeric_limits<double>::infinity();
  const double count = static_cast<double>(pixels_.size());
  return mean > 0.0 ? std::sqrt(squared_error / count) / (mean / count) : 0.0;
}

void Renderer::write_layers(ReferenceResult& result) const {
  LayeredImage& image = result.image;
  image.width = settings_.width;
  image.height = settings_.height;
  image.require("", 3);
  for (std::size_t l = 0; l < kLayers.size(); ++l) {
    Image& layer = image.require(kLayers[l].name, 3);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      put(layer, p, pixels_[p].sums[l] / static_cast<double>(settings_.samples));
    }
  }
  // Add up the parts, so that the total is their sum to the bit
  Image& whole = *image.find("");
  for (const char* part : {"direct", "indirect", "glossy", "transmission", "emission", "fog"}) {
    const Image& layer = *image.find(part);
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) whole.pixels[i] += layer.pixels[i];
  }
  write_first_hits(image);
  result.relative_standard_error = write_errors(image);
  result.rays = rays_ + pixels_.size();
}

}  // namespace

ReferenceResult render_reference(const World& world, const Camera& camera,
                                 const ReferenceSettings& settings, const ProgressFn& progress) {
  assert(settings.width > 0 && settings.height > 0 && settings.samples > 0);
  const auto start = std::chrono::steady_clock::now();
  Renderer renderer(world, camera, settings);
  renderer.render(progress);
  ReferenceResult result;
  renderer.write_layers(result);
  result.ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace lambent
