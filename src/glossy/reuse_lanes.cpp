// SPDX-License-Identifier: Apache-2.0
// Highway compiles this file once for each instruction set and picks the best one that the machine
// supports. Products and sums are not fused, so that all of them compute the same bits.
#include "glossy/reuse_lanes.h"

// Instruction sets that differ in nothing that is used here
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "glossy/reuse_lanes.cpp"
// clang-format off: foreach_target has to come first
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lambent {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
using Mask = hn::Mask<D>;

HWY_INLINE V number(float value) {
  return hn::Set(D(), value);
}

struct V3 {
  V x, y, z;
};

HWY_INLINE V3 plus(V3 a, V3 b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 minus(V3 a, V3 b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 times(V3 a, V b) {
  return {hn::Mul(a.x, b), hn::Mul(a.y, b), hn::Mul(a.z, b)};
}
HWY_INLINE V dot(V3 a, V3 b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 cross(V3 a, V3 b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
HWY_INLINE V3 normalized(V3 a) {
  return times(a, hn::Div(number(1.0f), hn::Sqrt(dot(a, a))));
}
HWY_INLINE V3 where(Mask mask, V3 yes, V3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

/// Planes of numbers, at the pixels of the lanes.
struct Planes {
  const float* first;
  std::size_t pitch;

  HWY_INLINE V at(int plane) const {
    return hn::LoadU(D(), first + static_cast<std::size_t>(plane) * pitch);
  }
  HWY_INLINE V3 three_at(int plane) const { return {at(plane), at(plane + 1), at(plane + 2)}; }
};

/// CoatLobe of the pixels of the lanes.
struct Lobes {
  V3 normal, viewer;
  V square_alpha, pdf_scale;
};

HWY_INLINE Lobes lobes_at(const Planes& pixels) {
  return {pixels.three_at(kLobeNormal), pixels.three_at(kLobeViewer), pixels.at(kLobeSquareAlpha),
          pixels.at(kLobePdfScale)};
}

/// Density of lobes towards directions, see coat_lobe(). Also returns the half vectors and the
/// cosines to the normals, for later use.
HWY_INLINE V lobe_pdf(const Lobes& of, V3 direction, V3& h, V& n_dot_l) {
  h = normalized(plus(of.viewer, direction));
  n_dot_l = dot(of.normal, direction);
  const V cosine = dot(of.normal, h);
  const V3 sine = cross(of.normal, h);
  const V d = hn::Add(hn::Mul(hn::Mul(cosine, cosine), of.square_alpha), dot(sine, sine));
  const V density = hn::Div(hn::Mul(of.square_alpha, number(kInvPi)), hn::Mul(d, d));
  return hn::IfThenElseZero(hn::Gt(n_dot_l, number(0.0f)), hn::Mul(density, of.pdf_scale));
}

/// Same as ggx_lambda().
HWY_INLINE V lambda_of(V cosine, V square_alpha) {
  const V square = hn::Mul(cosine, cosine);
  const V tangent = hn::Div(hn::Max(number(0.0f), hn::Sub(number(1.0f), square)),
                            hn::Max(square, number(1e-12f)));
  const V root = hn::Sqrt(hn::Add(number(1.0f), hn::Mul(square_alpha, tangent)));
  return hn::Mul(number(0.5f), hn::Sub(root, number(1.0f)));
}

/// Same as direction_to_end(): the directions from one place to the ends of rays that start at
/// another.
HWY_INLINE V3 directions_to_end(V3 from_ray_to_eye, V3 direction, V distance) {
  const Mask missed = hn::Eq(distance, number(infinity()));
  const V3 there = normalized(minus(times(direction, distance), from_ray_to_eye));
  return where(missed, direction, there);
}

/// Pixels that receive the light of rays, and their sums.
struct Receivers {
  V3 position, geometric_normal;
  Lobes lobes;
  V lambda;
  V inverse_tolerance;
  Mask receive, has_lobe;
  // Their own rays
  Mask has_own, has_own_pdf;
  V3 own_direction;
  V own_distance, own_value, own_lobe_pdf;
  V3 mirror;
  V inverse_mirror_pdf;
  V3 f0, to_f90;

  V3 light, emission;
  V weight, schlick, own_weight, pixels, fitting;
};

HWY_INLINE Receivers receivers_at(const Planes& coats, const Planes& more) {
  const V zero = number(0.0f);
  Receivers at;
  at.position = coats.three_at(kLobePosition);
  at.geometric_normal = coats.three_at(kLobeGeometricNormal);
  at.lobes = lobes_at(coats);
  at.lambda = coats.at(kLobeLambda);
  at.inverse_tolerance = more.at(kInverseTolerance);
  at.receive = hn::Gt(more.at(kReceives), zero);
  at.has_own = hn::Gt(coats.at(kRayPdf), zero);
  at.has_own_pdf = hn::Ne(coats.at(kRayPdf), zero);
  at.own_direction = coats.three_at(kRayDirection);
  at.own_distance = coats.at(kRayDistance);
  at.own_value = more.at(kOwnValue);
  at.own_lobe_pdf = more.at(kOwnLobePdf);
  at.mirror = more.three_at(kMirror);
  at.inverse_mirror_pdf = more.at(kInverseMirrorPdf);
  at.f0 = more.three_at(kF0);
  at.to_f90 = minus(more.three_at(kF90), at.f0);
  at.light = at.emission = {zero, zero, zero};
  at.weight = at.schlick = at.own_weight = at.pixels = at.fitting = zero;
  return at;
}

/// Same as relit_bilateral_weight().
HWY_INLINE V similarity(const Receivers& at, V3 offset, V3 geometric_normal) {
  const V cosine = hn::Max(number(0.0f), dot(at.geometric_normal, geometric_normal));
  const V square = hn::Mul(cosine, cosine);
  const V fourth = hn::Mul(square, square);
  const V eighth = hn::Mul(fourth, fourth);
  const V beyond = hn::Mul(dot(at.geometric_normal, offset), at.inverse_tolerance);
  return hn::Mul(hn::Mul(eighth, eighth),
                 hn::Max(number(0.0f), hn::Sub(number(1.0f), hn::Mul(beyond, beyond))));
}

/// Same as schlick_power().
HWY_INLINE V schlick_of(V cosine) {
  const V one = number(1.0f);
  const V m = hn::Min(hn::Max(hn::Sub(one, cosine), number(0.0f)), one);
  const V m2 = hn::Mul(m, m);
  return hn::Mul(hn::Mul(m2, m2), m);
}

/// Same as add_light_of_ray(), for rays with these weights and powers of Schlick's approximation.
HWY_INLINE void add_light(Receivers& at, const Planes& from, V m5, V lobe_pdf_there, V weight) {
  const V one = number(1.0f);
  const V3 reflected = times(plus(at.f0, times(at.to_f90, m5)), weight);
  const V3 radiance = from.three_at(kRayRadiance);
  at.light.x = hn::Add(at.light.x, hn::Mul(reflected.x, radiance.x));
  at.light.y = hn::Add(at.light.y, hn::Mul(reflected.y, radiance.y));
  at.light.z = hn::Add(at.light.z, hn::Mul(reflected.z, radiance.z));
  // Compute found_light_weight()
  const V ratio = hn::Div(from.at(kRayEmissionDensity), lobe_pdf_there);
  const V found = hn::IfThenElseZero(hn::Gt(lobe_pdf_there, number(0.0f)),
                                     hn::Div(one, hn::Add(one, hn::Mul(ratio, ratio))));
  const V3 emission = times(from.three_at(kRayEmission), found);
  at.emission.x = hn::Add(at.emission.x, hn::Mul(reflected.x, emission.x));
  at.emission.y = hn::Add(at.emission.y, hn::Mul(reflected.y, emission.y));
  at.emission.z = hn::Add(at.emission.z, hn::Mul(reflected.z, emission.z));
}

/// Same as add_coat_ray(), for one neighbour of each receiver.
HWY_INLINE void add_rays(Receivers& at, const Planes& from, V weight) {
  const V zero = number(0.0f);
  const V ray_pdf = from.at(kRayPdf);
  const V3 offset = minus(from.three_at(kLobePosition), at.position);
  V pixel = hn::Mul(weight, similarity(at, offset, from.three_at(kLobeGeometricNormal)));
  Mask counts =
      hn::And(hn::And(at.receive, hn::Ne(ray_pdf, zero)), hn::Ge(pixel, number(kLeastPixelWeight)));
  if (hn::AllFalse(D(), counts)) return;
  pixel = hn::IfThenElseZero(counts, pixel);
  at.pixels = hn::Add(at.pixels, pixel);

  // Compute how well the neighbours' lobes fit, and the weights of the receivers' own rays
  V3 h;
  V n_dot_l;
  const Lobes lobes = lobes_at(from);
  const V fitting =
      hn::Min(hn::Mul(lobe_pdf(lobes, at.mirror, h, n_dot_l), at.inverse_mirror_pdf), number(1.0f));
  at.fitting = hn::Add(at.fitting, hn::IfThenElseZero(counts, hn::Mul(pixel, fitting)));
  const V beside =
      lobe_pdf(lobes, directions_to_end(offset, at.own_direction, at.own_distance), h, n_dot_l);
  const V own_share = number(kOwnShare);
  const V own = hn::Div(hn::Mul(hn::Mul(pixel, own_share), at.own_value),
                        hn::Add(beside, hn::Mul(own_share, at.own_lobe_pdf)));
  at.own_weight = hn::Add(at.own_weight, hn::IfThenElseZero(hn::And(counts, at.has_own), own));

  // Weigh the neighbours' rays by the receivers' lobes
  counts = hn::And(counts, hn::Gt(ray_pdf, zero));
  const V3 direction = directions_to_end(minus({zero, zero, zero}, offset),
                                         from.three_at(kRayDirection), from.at(kRayDistance));
  const V pdf = lobe_pdf(at.lobes, direction, h, n_dot_l);
  const V value =
      hn::Div(hn::Mul(pdf, hn::Add(number(1.0f), at.lambda)),
              hn::Add(hn::Add(number(1.0f), at.lambda), lambda_of(n_dot_l, at.lobes.square_alpha)));
  counts = hn::And(counts, hn::Gt(value, zero));
  if (hn::AllFalse(D(), counts)) return;
  const V balanced = hn::Div(value, hn::Add(ray_pdf, hn::Mul(own_share, pdf)));
  const V alone = hn::Min(hn::Div(value, ray_pdf), number(kMaxReuseWeight));
  const V w =
      hn::IfThenElseZero(counts, hn::Mul(pixel, hn::IfThenElse(at.has_own_pdf, balanced, alone)));
  const V m5 = hn::IfThenElseZero(counts, schlick_of(dot(at.lobes.viewer, h)));
  at.weight = hn::Add(at.weight, w);
  at.schlick = hn::Add(at.schlick, hn::Mul(w, m5));
  const Mask above = hn::Gt(dot(at.geometric_normal, direction), zero);
  counts = hn::And(counts, above);
  if (hn::AllFalse(D(), counts)) return;
  add_light(at, from, m5, hn::IfThenElseZero(counts, pdf), hn::IfThenElseZero(counts, w));
}

/// Planes of sums, at the pixels of the lanes.
struct SumPlanes {
  float* first;
  std::size_t pitch;

  HWY_INLINE void put(int plane, V value) const {
    hn::StoreU(value, D(), first + static_cast<std::size_t>(plane) * pitch);
  }
  HWY_INLINE void put(int plane, V3 value) const {
    put(plane, value.x);
    put(plane + 1, value.y);
    put(plane + 2, value.z);
  }
};

HWY_INLINE void store_sums(const Receivers& at, const SumPlanes& sums) {
  sums.put(kSumLight, at.light);
  sums.put(kSumEmission, at.emission);
  sums.put(kSumWeight, at.weight);
  sums.put(kSumSchlick, at.schlick);
  sums.put(kSumOwnWeight, at.own_weight);
  sums.put(kSumPixels, at.pixels);
  sums.put(kSumFitting, at.fitting);
}

}  // namespace

void reuse_in_lanes(const ReuseRow& row, RowPlanes& sums) {
  const auto lanes = static_cast<int>(hn::Lanes(D()));
  const std::size_t pitch = row.coats.pitch();
  for (int x = 0; x < row.width; x += lanes) {
    const Planes own{row.coats.at(row.row, 0) + x, pitch};
    Receivers at = receivers_at(own, {row.receivers.at(row.receiver_row, 0) + x, pitch});
    if (hn::AllFalse(D(), at.receive)) continue;
    for (const NeighbourRow& neighbours : row.around) {
      for (int dx = -kReuse; dx <= kReuse; ++dx) {
        if (neighbours.own && dx == 0) continue;
        const float outermost = dx == -kReuse || dx == kReuse ? 0.5f : 1.0f;
        add_rays(at, {row.coats.at(neighbours.row, 0) + x + dx, pitch},
                 number(outermost * neighbours.weight));
      }
    }
    store_sums(at, {sums.at(row.receiver_row, 0) + x, sums.pitch()});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lambent
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lambent {
namespace {

HWY_EXPORT(reuse_in_lanes);

}  // namespace

void reuse_row(const ReuseRow& row, RowPlanes& sums) {
  HWY_DYNAMIC_DISPATCH(reuse_in_lanes)(row, sums);
}

}  // namespace lambent
#endif  // HWY_ONCE
