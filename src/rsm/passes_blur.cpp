// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/parallel.h"
#include "rsm/deinterleave.h"
#include "rsm/gather.h"
#include "rsm/passes.h"

namespace lambent {
namespace {

// Rows that a task blurs together. With more, less of the neighbours' work is repeated; fewer stay
// in the second-level cache.
constexpr int kRowsPerTask = 32;

/// The most recent rows of horizontally blurred light, by number. They are few enough to stay in
/// the cache until they are blurred vertically.
class RowRing {
 public:
  RowRing(int rows, int width)
      : rows_(rows), layout_(width, rows, kLightPlanes, 0), floats_(layout_.size) {}
  Planes row(int y) { return {floats_.data() + layout_.row(y % rows_), layout_.stride}; }

 private:
  int rows_;
  PlaneLayout layout_;
  AlignedFloats floats_;
};

/// Distance of the farthest tap.
int reach(std::span<const BlurTap> taps) {
  int farthest = 0;
  for (const BlurTap& tap : taps) farthest = std::max(farthest, tap.distance);
  return farthest;
}

/// Blurs row `row` of sub-image (i, j) horizontally, with taps `unit` pixels of the picture apart.
void blur_along_row(Mosaic& mosaic, int i, int j, int row, int unit, std::span<const BlurTap> taps,
                    const Planes& out, float tolerance) {
  std::vector<BlurSource> neighbours;
  for (const BlurTap& tap : taps) {
    for (const int dx : {-unit * tap.distance, unit * tap.distance}) {
      neighbours.push_back({mosaic.guide(i, j, row, dx, 0),
                            mosaic.light(Mosaic::Light::current, i, j, row, dx, 0), tap.weight});
    }
  }
  cross_bilateral_row(
      {mosaic.guide(i, j, row), mosaic.light(Mosaic::Light::current, i, j, row), 1.0f}, neighbours,
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
    RowRing band(2 * margin + 1, mosaic.layout().width);
    std::vector<BlurSource> neighbours;
    int ready = from;
    for (int row = first; row < last; ++row) {
      // Blur rows horizontally just before they are needed, so that their guides stay in the cache
      for (; ready < std::min(to, row + margin + 1); ++ready) {
        blur_along_row(mosaic, i, j, ready, unit, taps, band.row(ready), settings.plane_tolerance);
      }
      neighbours.clear();
      for (const BlurTap& tap : taps) {
        for (const int dy : {-apart * tap.distance, apart * tap.distance}) {
          if (row + dy < from || row + dy >= to) continue;
          neighbours.push_back({mosaic.guide(i, j, row + dy), band.row(row + dy), tap.weight});
        }
      }
      cross_bilateral_row({mosaic.guide(i, j, row), band.row(row), 1.0f}, neighbours,
                          mosaic.light(Mosaic::Light::next, i, j, row), mosaic.layout().width,
                          settings.plane_tolerance);
    }
  });
  mosaic.swap_lights();
}

namespace {

/// Writes a row of the picture from one row of each of its sub-images.
void interleave_row(const Mosaic& mosaic, int y, std::span<const ConstPlanes> subs,
                    std::span<glm::vec3> picture) {
  glm::vec3* to = picture.data() + static_cast<std::size_t>(y) * mosaic.width();
  const int p = mosaic.sub_images();
  for (int x = 0, place = 0; x < mosaic.width(); x += p, ++place) {
    const int count = std::min(p, mosaic.width() - x);
    for (int i = 0; i < count; ++i) {
      const ConstPlanes& from = subs[i];
      to[x + i] = {from.at(0)[place], from.at(1)[place], from.at(2)[place]};
    }
  }
}

/// Blurs rows [first, last) of the picture, and writes them.
void interleave_band(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic,
                     int first, int last, std::span<glm::vec3> picture) {
  const int p = mosaic.sub_images(), width = mosaic.layout().width, margin = reach(taps);
  const int from = std::max(0, first - margin), to = std::min(mosaic.height(), last + margin);
  // A row of the picture is p rows of sub-images, one after the other
  RowRing band((2 * margin + 1) * p, width);
  std::vector<BlurSource> neighbours;
  RowRing relit(p, width);
  std::vector<ConstPlanes> subs;
  int ready = from;
  for (int y = first; y < last; ++y) {
    for (; ready < std::min(to, y + margin + 1); ++ready) {
      for (int i = 0; i < p; ++i) {
        blur_along_row(mosaic, i, ready % p, ready / p, 1, taps, band.row(ready * p + i),
                       settings.plane_tolerance);
      }
    }
    subs.clear();
    for (int i = 0; i < p; ++i) {
      neighbours.clear();
      for (const BlurTap& tap : taps) {
        for (const int other : {y - tap.distance, y + tap.distance}) {
          if (other < from || other >= to) continue;
          neighbours.push_back(
              {mosaic.guide(i, other % p, other / p), band.row(other * p + i), tap.weight});
        }
      }
      cross_bilateral_row_relit({mosaic.guide(i, y % p, y / p), band.row(y * p + i), 1.0f},
                                neighbours, relit.row(i), width, settings.plane_tolerance);
      subs.push_back(relit.row(i));
    }
    interleave_row(mosaic, y, subs, picture);
  }
}

}  // namespace

void interleave(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic,
                std::span<glm::vec3> picture) {
  const int p = mosaic.sub_images();
  parallel_chunks(mosaic.height(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    const int first = static_cast<int>(begin), last = static_cast<int>(end);
    if (!taps.empty()) return interleave_band(taps, settings, mosaic, first, last, picture);
    std::vector<ConstPlanes> subs;
    RowRing relit(p, mosaic.layout().width);
    for (int y = first; y < last; ++y) {
      subs.clear();
      for (int i = 0; i < p; ++i) {
        const Planes light = mosaic.light(Mosaic::Light::current, i, y % p, y / p);
        subs.push_back(blurs(settings) ? relit.row(i) : light);
        if (!blurs(settings)) continue;
        cross_bilateral_row_relit({mosaic.guide(i, y % p, y / p), light, 1.0f}, {}, relit.row(i),
                                  mosaic.layout().width, settings.plane_tolerance);
      }
      interleave_row(mosaic, y, subs, picture);
    }
  });
}

}  // namespace lambent
