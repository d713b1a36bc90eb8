// SPDX-License-Identifier: Apache-2.0
#include "lambent/denoise.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "core/large_pages.h"
#include "core/parallel.h"
#include "denoise/atrous_cpu.h"
#include "denoise/denoise_passes.h"

namespace lambent {
namespace {

constexpr int kMaxSide = 16384;  // of a picture [pixels]
// Rows that a task filters: few enough to keep all cores busy, many enough to stay in the cache.
constexpr std::size_t kRowsPerTask = 8;

template <class Body>
void for_each_row(int height, Body body) {
  parallel_chunks(static_cast<std::size_t>(height), kRowsPerTask,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
                  });
}

/// A picture of planes, with a border.
struct PlanePicture {
  void shape(int picture_width, int height, int planes) {
    if (width == picture_width && layout.height == height && layout.planes == planes) return;
    width = picture_width;
    // The layout's padding is shared by the end of one plane and the start of the next, and so can
    // hold the border to the left alone: that to the right is pixels of the layout
    layout = PlaneLayout(width + kDenoiseGuard, height, planes, kDenoiseGuard);
    floats.assign(layout.size, 0.0f);
  }
  Planes row(int y) { return {floats.data() + layout.row(y), layout.stride}; }
  std::ptrdiff_t row_floats() const { return layout.planes * layout.stride; }
  /// Mirrors the picture in this much of its border.
  void mirror(int border) {
    for_each_row(layout.height, [&](int y) {
      const Planes pixels = row(y);
      for (int plane = 0; plane < layout.planes; ++plane) {
        float* const at = pixels.at(plane);
        for (int x = 1; x <= border; ++x) {
          const int beyond = width - 1 + x;
          at[-x] = at[mirrored_place(-x, width)];
          at[beyond] = at[mirrored_place(beyond, width)];
        }
      }
    });
    for (int y = 1; y <= border; ++y) {
      const int beyond = layout.height - 1 + y;
      copy_row(mirrored_place(-y, layout.height), -y);
      copy_row(mirrored_place(beyond, layout.height), beyond);
    }
  }
  void copy_row(int from, int to) {
    const float* const first = row(from).first - layout.lead;
    std::copy(first, first + row_floats(), row(to).first - layout.lead);
  }

  int width = 0;
  PlaneLayout layout;
  AlignedFloats floats;
};

/// Mirrors light in as much of its border as a pass reads.
void mirror_light(PlanePicture& light, int apart) {
  light.mirror(apart);
  const int height = light.layout.height;
  for (int y = -apart; y < height + apart; ++y) {
    float* const shares = light.row(y).at(kSharePlane);
    const int above = beyond_ends(y, height);
    const float factor = mirrored_share(above, apart);
    if (above > 0) {
      for (int x = 0; x < light.width; ++x) shares[x] *= factor;
    }
    for (int x = 1; x <= apart; ++x) {
      const float sideways = factor * mirrored_share(x, apart);
      shares[-x] *= sideways;
      shares[light.width - 1 + x] *= sideways;
    }
  }
}

void store_vector(const Planes& to, int plane, int x, const vec3& v) {
  for (int c = 0; c < 3; ++c) to.at(plane + c)[x] = v[c];
}

vec3 load_vector(const Planes& from, int plane, int x) {
  return {from.at(plane)[x], from.at(plane + 1)[x], from.at(plane + 2)[x]};
}

bool has_lobes(const DenoiseView& view) {
  return !view.lobes.alphas.empty();
}

/// Whether a pixel's light is filtered.
bool is_filtered(const DenoiseView& view, std::size_t pixel) {
  return view.depths[pixel] > 0.0f && (!has_lobes(view) || view.lobes.alphas[pixel] > 0.0f);
}

/// Fills a picture of `planes` planes: write(row, x, i) stores pixel i at place x of its row.
template <class Write>
void fill_planes(const DenoiseView& view, int planes, PlanePicture& picture, Write write) {
  picture.shape(view.width, view.height, planes);
  for_each_row(view.height, [&](int y) {
    const Planes row = picture.row(y);
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width);
    for (int x = 0; x < view.width; ++x) write(row, x, first + static_cast<std::size_t>(x));
  });
}

void load_guide(const DenoiseView& view, std::span<const float> levels, PlanePicture& guide) {
  fill_planes(view, kDenoiseGuidePlanes, guide, [&](const Planes& row, int x, std::size_t i) {
    const bool seen = is_filtered(view, i);
    store_vector(row, kPositionPlane, x, view.positions_ws[i]);
    store_vector(row, kNormalPlane, x, seen ? view.normals_ws[i] : vec3(0.0f));
    row.at(kInverseDepthPlane)[x] = seen ? 1.0f / view.depths[i] : 0.0f;
    row.at(kLevelPlane)[x] = levels.empty() ? 0.0f : levels[i];
  });
}

void load_lobes(const DenoiseView& view, PlanePicture& lobes) {
  fill_planes(view, kLobePlanes, lobes, [&](const Planes& row, int x, std::size_t i) {
    LobeGuide guide{};
    if (is_filtered(view, i)) {
      guide = lobe_guide(view.normals_ws[i], view.lobes.to_viewer_ws[i], view.lobes.alphas[i],
                         view.lobes.inverse_distances[i]);
    }
    store_vector(row, kMirrorPlane, x, guide.mirror_ws);
    store_vector(row, kAcrossPlane, x, guide.across_ws);
    row.at(kLobeSharpnessPlane)[x] = guide.sharpness;
    row.at(kInverseHitDistancePlane)[x] = guide.inverse_distance;
  });
}

// What fireflies.inl.h requires of its includer.
struct NoisyPixel {
  const DenoiseView& view;
  std::span<const vec3> light;
  ivec2 place;
};
using NoisyPixelRef = const NoisyPixel&;
float fetch_luminance(const NoisyPixel& pixel, int x, int y) {
  const ivec2 at = pixel.place + ivec2(x, y);
  if (at.x < 0 || at.y < 0 || at.x >= pixel.view.width || at.y >= pixel.view.height) return 0.0f;
  return luminance(finite_or_dark(
      pixel.light[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(pixel.view.width) +
                  static_cast<std::size_t>(at.x)]));
}

#include "denoise/fireflies.inl.h"

/// Loads light, or a part of it: kWholeLight, or of light with variances kWithoutFireflies or
/// kFirefliesAlone. Returns whether there are fireflies, of a part.
bool load_light(const DenoiseView& view, const NoisyLight& light, uint part, PlanePicture& to) {
  const bool has_base = !light.base.empty(), measured = !light.variance.empty();
  const std::span<const float> variances = measured ? light.variance : light.history_variance;
  const bool known = !variances.empty() && part != kFirefliesAlone;
  std::atomic<bool> any = false;
  fill_planes(view, kDenoisePlanes, to, [&](const Planes& row, int x, std::size_t i) {
    const float variance = variances.empty() ? 0.0f : finite_or_dark(variances[i]);
    float share = 1.0f;
    if (part != kWholeLight) {
      const int y = static_cast<int>(i / static_cast<std::size_t>(view.width));
      const float firefly = firefly_share({view, light.light, {x, y}}, variance);
      if (firefly > 0.0f) any.store(true, std::memory_order_relaxed);
      share = part == kFirefliesAlone ? firefly : 1.0f - firefly;
    }
    const vec3 noisy = share * finite_or_dark(light.light[i]);
    const vec3 base = has_base ? finite_or_dark(light.base[i]) : vec3(0.0f);
    store_vector(row, kLightPlane, x, noisy);
    row.at(kSpreadPlane)[x] = known ? share * share * variance : unmeasured_spread(noisy, base);
    row.at(kSharePlane)[x] = 1.0f;
    if (has_base) store_vector(row, kBasePlane, x, base);
  });
  return any;
}

NoiseFrom noise_from(const NoisyLight& light) {
  if (!light.variance.empty()) return NoiseFrom::samples;
  return light.history_variance.empty() ? NoiseFrom::neighbours : NoiseFrom::history;
}

/// Stores the filtered light with the detail of its base, if any, or adds it to what is there.
void store_light(const DenoiseView& view, PlanePicture& from, std::span<const vec3> base, bool adds,
                 std::span<vec3> filtered) {
  for_each_row(view.height, [&](int y) {
    const Planes row = from.row(y);
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width);
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = first + static_cast<std::size_t>(x);
      vec3 light = load_vector(row, 0, x);
      if (!base.empty()) light = with_detail(light, load_vector(row, kBasePlane, x), base[i]);
      filtered[i] = adds ? filtered[i] + light : light;
    }
  });
}

Expected<void> check(const DenoiseView& view, const NoisyLight& light,
                     std::span<glm::vec3> filtered) {
  if (view.width < 1 || view.width > kMaxSide || view.height < 1 || view.height > kMaxSide) {
    return fail("", "denoise view", "a side is not between 1 and 16384");
  }
  const std::size_t pixels =
      static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  const bool lobes = has_lobes(view);
  struct Span {
    const char* name;
    std::size_t size;
    bool may_be_empty;
  };
  for (const Span& span :
       {Span{"positions", view.positions_ws.size(), false},
        Span{"normals", view.normals_ws.size(), false}, Span{"depths", view.depths.size(), false},
        Span{"alphas of lobes", view.lobes.alphas.size(), true},
        Span{"viewers of lobes", view.lobes.to_viewer_ws.size(), !lobes},
        Span{"distances of lobes", view.lobes.inverse_distances.size(), !lobes},
        Span{"light", light.light.size(), false}, Span{"base", light.base.size(), true},
        Span{"variance", light.variance.size(), true},
        Span{"variance of the history", light.history_variance.size(), true},
        Span{"levels", light.levels.size(), true},
        Span{"filtered light", filtered.size(), false}}) {
    if (span.size == pixels || (span.may_be_empty && span.size == 0)) continue;
    return fail(
        "", span.name,
        "has " + std::to_string(span.size) + " elements for " + std::to_string(pixels) + " pixels");
  }
  if (lobes && (!light.base.empty() || !light.levels.empty())) {
    return fail("", "noisy light", "of lobes has a base or levels");
  }
  if (!light.variance.empty() && !light.history_variance.empty()) {
    return fail("", "noisy light", "has variances of samples and of a history");
  }
  if (!light.base.empty() && !light.levels.empty()) {
    return fail("", "noisy light", "has both a base and levels");
  }
  return {};
}

}  // namespace

struct Denoiser::State {
  PlanePicture guide, lobes, light[2];

  /// Runs a pass from the picture light[from] to the other one.
  void run(const AtrousPass& pass, int from) {
    const PlaneLayout& layout = guide.layout;
    const bool lobed = pass.has_lobes != 0;
    mirror_light(light[from], pass.apart);
    for_each_row(layout.height, [&](int y) {
      filter_row(pass, {guide.row(y), lobed ? lobes.row(y) : Planes{}, light[from].row(y),
                        light[1 - from].row(y), guide.row_floats(), lobed ? lobes.row_floats() : 0,
                        light[from].row_floats(), guide.width});
    });
  }
  /// Runs passes, the first of the picture light[0]. Returns the index of the result.
  int run_all(const std::vector<AtrousPass>& passes) {
    int at = 0;
    for (const AtrousPass& pass : passes) {
      run(pass, at);
      at = 1 - at;
    }
    return at;
  }
};

Denoiser::Denoiser() : state_(new State) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

Expected<void> Denoiser::filter(const DenoiseView& view, const NoisyLight& light,
                                const DenoiseSettings& settings, std::span<glm::vec3> filtered) {
  if (const Expected<void> fine = lambent::check(settings); !fine) return fine;
  if (const Expected<void> fine = check(view, light, filtered); !fine) return fine;
  State& s = *state_;
  load_guide(view, light.levels, s.guide);
  s.guide.mirror(kDenoiseGuard);
  if (has_lobes(view)) {
    load_lobes(view, s.lobes);
    s.lobes.mirror(kDenoiseGuard);
  }
  s.light[1].shape(view.width, view.height, kDenoisePlanes);
  const bool has_base = !light.base.empty(), has_levels = !light.levels.empty();
  const bool splits = has_levels && !light.variance.empty();
  const bool fireflies =
      load_light(view, light, splits ? kWithoutFireflies : kWholeLight, s.light[0]);
  int at =
      s.run_all(denoise_passes(settings, has_base, noise_from(light), has_levels, has_lobes(view)));
  store_light(view, s.light[at], light.base, /*adds=*/false, filtered);
  if (!fireflies) return {};
  load_light(view, light, kFirefliesAlone, s.light[0]);
  at = s.run_all(denoise_passes(firefly_denoising(settings), has_base, NoiseFrom::neighbours,
                                has_levels, has_lobes(view)));
  store_light(view, s.light[at], light.base, /*adds=*/true, filtered);
  return {};
}

}  // namespace lambent
