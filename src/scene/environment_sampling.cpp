// SPDX-License-Identifier: Apache-2.0
#include "scene/environment_sampling.h"

#include <algorithm>
#include <cmath>

#include "shared/color.h"
#include "shared/constants.h"

namespace lambent {
namespace {

glm::vec3 texel(const Image& map, int x, int y) {
  x = (x % map.width + map.width) % map.width;
  y = std::clamp(y, 0, map.height - 1);
  const float* p = map.at(x, y);
  return {p[0], p[1], p[2]};
}

// Mean luminance of the bilinear interpolation over the cell around texel (x, y): the 1-6-1 tent.
float cell_luminance(const Image& map, int x, int y) {
  constexpr float kTent[3] = {0.125f, 0.75f, 0.125f};
  float sum = 0.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      sum += kTent[dx + 1] * kTent[dy + 1] * luminance(texel(map, x + dx, y + dy));
    }
  }
  return std::max(sum, 0.0f);
}

// Makes `weights` cumulative and of sum 1, in place; uniform where all are 0. Returns their sum.
double accumulate(float* weights, int count) {
  double total = 0.0;
  for (int i = 0; i < count; ++i) total += weights[i];
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    sum += weights[i];
    weights[i] = static_cast<float>(total > 0.0 ? sum / total : (i + 1.0) / count);
  }
  return total;
}

// The cell of a cumulative table that contains `u`, the continuous position, and the cell's
// probability.
struct TableSample {
  int cell;
  float place;  // cell + fraction
  float probability;
};

TableSample sample_table(const float* cumulative, int count, float u) {
  const int cell =
      std::min(static_cast<int>(std::upper_bound(cumulative, cumulative + count, u) - cumulative),
               count - 1);
  const float lower = cell > 0 ? cumulative[cell - 1] : 0.0f;
  const float probability = cumulative[cell] - lower;
  const float fraction = probability > 0.0f ? (u - lower) / probability : 0.5f;
  return {cell, static_cast<float>(cell) + std::min(fraction, kBelowOne), probability};
}

float table_probability(const float* cumulative, int cell) {
  return cumulative[cell] - (cell > 0 ? cumulative[cell - 1] : 0.0f);
}

// Solid angle of the whole map over its area, at the latitude of v: 2 pi^2 sin(theta).
float solid_angle_density(float v) {
  return kTwoPi * kPi * std::sin(kPi * v);
}

}  // namespace

EnvironmentDistribution::EnvironmentDistribution(const Environment& environment)
    : environment_(&environment) {
  const Image& map = environment.map;
  if (map.empty() || luminance(environment.radiance) <= 0.0f) return;
  width_ = map.width;
  height_ = map.height;
  cell_cumulative_.resize(static_cast<std::size_t>(width_) * height_);
  row_cumulative_.resize(height_);
  for (int y = 0; y < height_; ++y) {
    float* row = cell_cumulative_.data() + static_cast<std::size_t>(y) * width_;
    for (int x = 0; x < width_; ++x) row[x] = cell_luminance(map, x, y);
    const float sin_theta =
        std::sin(kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height_));
    row_cumulative_[y] = static_cast<float>(accumulate(row, width_)) * sin_theta;
  }
  if (accumulate(row_cumulative_.data(), height_) <= 0.0) row_cumulative_.clear();
}

EnvironmentSample EnvironmentDistribution::sample(const glm::vec2& u) const {
  if (empty()) return {};
  const TableSample row = sample_table(row_cumulative_.data(), height_, u.y);
  const TableSample cell = sample_table(
      cell_cumulative_.data() + static_cast<std::size_t>(row.cell) * width_, width_, u.x);
  const glm::vec2 uv(cell.place / static_cast<float>(width_),
                     row.place / static_cast<float>(height_));
  const float solid_angle = solid_angle_density(uv.y);
  if (solid_angle <= 0.0f) return {};
  EnvironmentSample sample;
  sample.direction_ws = direction_from_latitude_longitude(uv, environment_->rotation);
  sample.radiance = environment_->radiance * sample_environment_map(environment_->map, uv);
  sample.pdf = row.probability * static_cast<float>(height_) * cell.probability *
               static_cast<float>(width_) / solid_angle;
  return sample;
}

float EnvironmentDistribution::pdf(const glm::vec3& direction_ws) const {
  if (empty()) return 0.0f;
  const glm::vec2 uv = latitude_longitude_from_direction(direction_ws, environment_->rotation);
  const int x = std::min(static_cast<int>(uv.x * static_cast<float>(width_)), width_ - 1);
  const int y = std::min(static_cast<int>(uv.y * static_cast<float>(height_)), height_ - 1);
  const float solid_angle = solid_angle_density(uv.y);
  if (solid_angle <= 0.0f) return 0.0f;
  return table_probability(row_cumulative_.data(), y) * static_cast<float>(height_) *
         table_probability(cell_cumulative_.data() + static_cast<std::size_t>(y) * width_, x) *
         static_cast<float>(width_) / solid_angle;
}

}  // namespace lambent
