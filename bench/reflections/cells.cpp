// SPDX-License-Identifier: Apache-2.0
// What a mirror's picture of a plain wall has at the frequencies of the field's cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bench/reflections/subject.h"
#include "shared/constants.h"

namespace lambent::reflections {
namespace {

// The view: parallel rays, straight to the mirror and back to the wall behind the camera, so that a
// pixel of the picture is a place of the wall.
constexpr float kExtent = 1.6f;         // height and width [m]
constexpr float kCentreHeight = 1.4f;   // [m]
constexpr float kInFrontOfWall = 2.5f;  // [m]

/// The amplitude of the waves of `period` [pixels] in a row of numbers, relative to their mean.
double amplitude(const std::array<double, kSide>& row, double period) {
  // Only whole waves count
  const int used = static_cast<int>(period * std::floor(kSide / period));
  double mean = 0.0, along = 0.0, across = 0.0, weights = 0.0;
  for (int i = 0; i < used; ++i) {
    // Without a window, the slope of the light would leak into all frequencies
    const double weight = 0.5 - 0.5 * std::cos(2.0 * static_cast<double>(kPi) * (i + 0.5) / used);
    const double turn = 2.0 * static_cast<double>(kPi) * i / period;
    mean += weight * row[i];
    along += weight * row[i] * std::cos(turn);
    across += weight * row[i] * std::sin(turn);
    weights += weight;
  }
  return mean > 0.0 ? 2.0 * std::hypot(along, across) / mean : 0.0;
}

/// Ratio of ours to the reference, averaged over columns or over rows.
std::array<double, kSide> profile(const Reflected& found, bool of_columns) {
  std::array<double, kSide> ours{}, reference{};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int i = of_columns ? x : y;
      for (int c = 0; c < 3; ++c) {
        ours[i] += found.ours.at(x, y)[c];
        reference[i] += found.reference.at(x, y)[c];
      }
    }
  }
  for (int i = 0; i < kSide; ++i) ours[i] /= reference[i];
  return ours;
}

Camera view_of_wall() {
  Camera camera =
      look_at({0.0f, kCentreHeight, kInFrontOfWall}, {0.0f, kCentreHeight, -3.0f}, 1.0f);
  camera.orthographic = true;
  camera.vertical_extent = kExtent;
  return camera;
}

}  // namespace

void measure_cells() {
  std::printf("### Waves in a mirror's picture of a plain wall, amplitude over the mean\n");
  std::printf("| cells, wide and high [m] | along x | half as long | along y | half as long |\n");
  std::printf("|---|---|---|---|---|\n");
  const Subject subject(room_with_plate(metal(0.0f)));
  const Reflected found = reflected_in(subject, view_of_wall(), kSide, kSamples);
  const glm::vec3 cell = subject.field.grids().front().spacing;
  const auto waves = [&](bool of_columns, float length) {
    return 100.0 * amplitude(profile(found, of_columns),
                             static_cast<double>(length) * kSide / static_cast<double>(kExtent));
  };
  std::printf("| %.2f, %.2f | %.2f %% | %.2f %% | %.2f %% | %.2f %% |\n", cell.x, cell.y,
              waves(true, cell.x), waves(true, 0.5f * cell.x), waves(false, cell.y),
              waves(false, 0.5f * cell.y));
}

}  // namespace lambent::reflections
