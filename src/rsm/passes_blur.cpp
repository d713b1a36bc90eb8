// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "core/parallel.h"
#include "rsm/deinterleave.h"
#include "rsm/passes.h"

namespace lambent {
namespace {

using LightPlanes = Mosaic::Light;

// Rows that a task blurs together. More repeat less of their neighbours' work, fewer stay in the
// second-level cache.
constexpr int kRowsPerTask = 32;

/// Light of rows around a band, blurred horizontally; rows are found by where they lie in a
/// sub-image, or in the picture.
class BandLight {
 public:
  BandLight(int first_row, int rows, int stride)
      : first_row_(first_row),
        stride_(stride),
        plane_(static_cast<std::size_t>(rows) * stride),
        floats_(std::make_unique_for_overwrite<float[]>(3 * plane_)) {}
  Planes3 row(int y) {
    float* first = floats_.get() + static_cast<std::size_t>(y - first_row_) * stride_;
    return {{first, first + plane_, first + 2 * plane_}};
  }

 private:
  int first_row_, stride_;
  std::size_t plane_;
  std::unique_ptr<float[]> floats_;
};

/// Farthest tap.
int reach(std::span<const BlurTap> taps) {
  int farthest = 0;
  for (const BlurTap& tap : taps) farthest = std::max(farthest, tap.distance);
  return farthest;
}

/// Blurs row `row` of sub-image (i, j) along the picture's rows, taps `unit` pixels apart.
void blur_along_row(Mosaic& mosaic, int i, int j, int row, int unit, std::span<const BlurTap> taps,
                    const Planes3& out, float tolerance) {
  std::vector<BlurSource> neighbours;
  for (const BlurTap& tap : taps) {
    for (const int dx : {-unit * tap.distance, unit * tap.distance}) {
      neighbours.push_back({mosaic.guide(i, j, row, dx, 0),
                            mosaic.light(LightPlanes::current, i, j, row, dx, 0), tap.weight});
    }
  }
  cross_bilateral_row(
      {mosaic.guide(i, j, row), mosaic.light(LightPlanes::current, i, j, row), 1.0f}, neighbours,
      out, mosaic.layout().width, tolerance);
}

}  // namespace

void blur_sub_images(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic) {
  // Where the picture is not restructured, a sub-image's neighbours are `unit` pixels apart
  const int p = mosaic.sub_images(), unit = settings.sub_images, apart = unit / p;
  const int rows = mosaic.layout().height, margin = reach(taps) * apart;
  const int bands = (rows + kRowsPerTask - 1) / kRowsPerTask;
  parallel_chunks(static_cast<std::size_t>(bands) * p * p, 1, [&](std::size_t task, std::size_t) {
    const int sub = static_cast<int>(task) % (p * p), i = sub % p, j = sub / p;
    const int first = static_cast<int>(task) / (p * p) * kRowsPerTask;
    const int last = std::min(rows, first + kRowsPerTask);
    const int from = std::max(0, first - margin), to = std::min(rows, last + margin);
    BandLight band(from, to - from, mosaic.layout().stride);
    for (int row = from; row < to; ++row) {
      blur_along_row(mosaic, i, j, row, unit, taps, band.row(row), settings.plane_tolerance);
    }
    std::vector<BlurSource> neighbours;
    for (int row = first; row < last; ++row) {
      neighbours.clear();
      for (const BlurTap& tap : taps) {
        for (const int dy : {-apart * tap.distance, apart * tap.distance}) {
          if (row + dy < from || row + dy >= to) continue;
          neighbours.push_back({mosaic.guide(i, j, row + dy), band.row(row + dy), tap.weight});
        }
      }
      cross_bilateral_row({mosaic.guide(i, j, row), band.row(row), 1.0f}, neighbours,
                          mosaic.light(LightPlanes::next, i, j, row), mosaic.layout().width,
                          settings.plane_tolerance);
    }
  });
  mosaic.swap_lights();
}

namespace {

/// Writes a row of a sub-image to the picture.
void scatter_row(const Mosaic& mosaic, int i, int y, const ConstPlanes3& from,
                 std::span<glm::vec3> picture) {
  const int p = mosaic.sub_images(), count = sub_image_size(mosaic.width(), i, p);
  glm::vec3* to = picture.data() + static_cast<std::size_t>(y) * mosaic.width() + i;
  for (int x = 0; x < count; ++x) {
    to[static_cast<std::ptrdiff_t>(x) * p] = {from.at[0][x], from.at[1][x], from.at[2][x]};
  }
}

/// Blurs rows [first, last) of the picture, and writes them there.
void interleave_band(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic,
                     int first, int last, std::span<glm::vec3> picture) {
  const int p = mosaic.sub_images(), stride = mosaic.layout().stride, margin = reach(taps);
  const int from = std::max(0, first - margin), to = std::min(mosaic.height(), last + margin);
  // A row of the picture is p rows of sub-images, one after the other
  BandLight band(from * p, (to - from) * p, stride);
  for (int y = from; y < to; ++y) {
    for (int i = 0; i < p; ++i) {
      blur_along_row(mosaic, i, y % p, y / p, 1, taps, band.row(y * p + i),
                     settings.plane_tolerance);
    }
  }
  std::vector<BlurSource> neighbours;
  BandLight blurred(0, 1, stride);
  for (int y = first; y < last; ++y) {
    for (int i = 0; i < p; ++i) {
      neighbours.clear();
      for (const BlurTap& tap : taps) {
        for (const int other : {y - tap.distance, y + tap.distance}) {
          if (other < from || other >= to) continue;
          neighbours.push_back(
              {mosaic.guide(i, other % p, other / p), band.row(other * p + i), tap.weight});
        }
      }
      cross_bilateral_row({mosaic.guide(i, y % p, y / p), band.row(y * p + i), 1.0f}, neighbours,
                          blurred.row(0), mosaic.layout().width, settings.plane_tolerance);
      scatter_row(mosaic, i, y, blurred.row(0), picture);
    }
  }
}

}  // namespace

void interleave(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic,
                std::span<glm::vec3> picture) {
  const int p = mosaic.sub_images();
  parallel_chunks(mosaic.height(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    const int first = static_cast<int>(begin), last = static_cast<int>(end);
    if (!taps.empty()) return interleave_band(taps, settings, mosaic, first, last, picture);
    for (int y = first; y < last; ++y) {
      for (int i = 0; i < p; ++i) {
        scatter_row(mosaic, i, y, mosaic.light(LightPlanes::current, i, y % p, y / p), picture);
      }
    }
  });
}

}  // namespace lambent
