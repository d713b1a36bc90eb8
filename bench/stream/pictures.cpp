// SPDX-License-Identifier: Apache-2.0
// Comparison of pictures that a client renders from a stream to those of the server's own field.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/stage.h"
#include "bench/stream/scenes.h"
#include "lambent/renderer.h"

namespace lambent::light_stream {
namespace {

constexpr int kUpdates = 24, kSize = 128;
// Target error of a stream, so small that the rounding of geometry is visible.
constexpr float kTargetError = 0.002f;

/// Differences of the indirect light of two pictures.
struct Difference {
  double mean = 0.0;      ///< Mean of the first one [W/(m^2 sr)].
  double ratio = 0.0;     ///< Ratio of the second one's mean to that.
  double relative = 0.0;  ///< Root mean square, over the mean [%].
  /// Root mean square of differences, each over the pixel plus a tenth of the mean [%].
  double dark = 0.0;
  double thousandth = 0.0;  ///< Exceeded by one such difference in a thousand [%].
};

Difference difference_of(const RenderedFrame& one, const RenderedFrame& other) {
  const std::vector<float>&a = one.image.find("indirect")->pixels,
        &b = other.image.find("indirect")->pixels;
  const auto count = static_cast<double>(a.size());
  double of_a = 0.0, of_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    of_a += static_cast<double>(a[i]);
    of_b += static_cast<double>(b[i]);
  }
  Difference result;
  result.mean = of_a / count;
  result.ratio = of_b / of_a;
  double squares = 0.0, dark = 0.0;
  std::vector<double> errors;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double error = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    errors.push_back(100.0 * error / (static_cast<double>(a[i]) + 0.1 * result.mean));
    squares += error * error;
    dark += errors.back() * errors.back();
  }
  std::sort(errors.begin(), errors.end());
  result.relative = 100.0 * std::sqrt(squares / count) / result.mean;
  result.dark = std::sqrt(dark / count);
  result.thousandth = errors[static_cast<std::size_t>(0.999 * (count - 1.0))];
  return result;
}

void measure(const std::string& name) {
  const Scene scene = bench::open_stage(name);
  const World world(scene);
  FieldSettings settings;
  settings.corrections = false;  // they are rounded, too, and noisy
  IrradianceField field =
      bench::value_or_throw(IrradianceField::make(settings, open_bounds(world)));
  for (int i = 0; i < kUpdates; ++i) field.update(world);
  auto encoder =
      bench::value_or_throw(stream::LightEncoder::create({.target_error = kTargetError}));
  stream::StreamedField client;
  for (const stream::LightMessage& message : bench::value_or_throw(encoder.encode(field))) {
    bench::value_or_throw(client.receive(message.bytes));
  }
  FrameSettings frame = quality_settings(Quality::interactive);
  frame.width = frame.height = kSize;
  for (const Camera& camera : scene.cameras) {
    const auto picture = [&](const IrradianceField& of) {
      return bench::value_or_throw(Renderer(world, {.field = &of}).render(camera, frame));
    };
    const Difference found = difference_of(picture(field), picture(*client.field()));
    std::printf("| %s, %s | %.3g | %.5f | %.3f, %.3f, %.3f |\n", name.c_str(), camera.name.c_str(),
                found.mean, found.ratio, found.relative, found.dark, found.thousandth);
  }
}

}  // namespace

void measure_pictures() {
  std::printf("### Indirect light of clients' pictures beside the server's\n");
  std::printf(
      "| scene, camera | mean [W/(m^2 sr)] | the client's mean, over that | differences: root mean "
      "square over the mean, the same over the pixel and a tenth of the mean, the 99.9th "
      "percentile "
      "of that [%%] |\n|---|---|---|---|\n");
  for (const char* name : {"two-rooms-sealed", "two-rooms", "house", "cornell", "atrium"}) {
    measure(name);
  }
}

}  // namespace lambent::light_stream
