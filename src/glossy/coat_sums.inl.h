// SPDX-License-Identifier: Apache-2.0
// Lobes of coats, and the sums over the rays of the pixels around one (in C++ also around several,
// in the lanes of a vector), in the common subset of C++ and GLSL. Without an include guard. The
// includer provides
//   Real, Real3      float and vec3, or lanes of them with the same operators and functions
//   CoatRay          as in coat_path.h, of these numbers
//   Reflectance      as in brdf.h, of these numbers; of its members, f0 and f90
//   LAMBENT_REAL_FN  before a function
//   Real select(condition, Real yes, Real no), and for Real3: see lang.h
//   condition left_scene(Real distance)   see coat_path.h
//   Real luminance(Real3)
//   bool all_zero(Real)                   whether further computations can be skipped
// and microfacet.inl.h, mis_weights.inl.h and relit_blur.inl.h for these numbers.

/// The specular lobe of a pixel: its place, its frame and its width. What depends on it alone is
/// computed once, not for each ray: see make_coat_lobe().
struct CoatLobe {
  Real3 position_ws;
  Real3 geometric_normal_ws;
  Real3 normal_ws;
  Real3 to_viewer_ws;
  Real squared_alpha;
  Real pdf_scale;  ///< Factor from the half vector's density to the pdf; 0: seen from below.
  Real lambda;     ///< smith_lambda() of the viewer.
};

/// A lobe's value for a direction of light, and the density with which it draws that direction.
struct LobeValue {
  Real value;    ///< BRDF times cosine over the Fresnel term [1/sr]; 0 below the surface.
  Real pdf;      ///< [1/sr]; 0 below the surface.
  Real v_dot_h;  ///< Cosine between the viewer and the half vector; 0 below the surface.
};

/// A pixel whose coat reflects the light of its own ray and of those around it.
struct CoatReceiver {
  CoatLobe lobe;
  Reflectance reflectance;  ///< See coat_under_layers().
  Real inverse_tolerance;   ///< One over kPlaneTolerance pixels at its depth [1/m].
  CoatRay own;              ///< The pixel's own ray; pdf 0 where it has none.
  LobeValue at_own;         ///< The lobe's value for that ray; 0 where there is none.
  Real3 mirror_ws;          ///< The mirror direction, where the lobe is about densest.
  Real inverse_mirror_pdf;  ///< One over the lobe's density there [sr]; 0: there is no lobe.
  Real density_scale;       ///< Of its samples of emitters, see emitter_density_scale() [m^2/W].
};

/// Weighted sums over rays.
struct CoatSums {
  Real3 light;            ///< Reflected light, without what direct light samples, too.
  Real3 emission;         ///< Reflected light that direct light samples, too; see CoatRay::apart.
  Real weight;            ///< Sum of the rays' weights.
  Real schlick;           ///< Sum of the weights times Schlick's (1 - v_dot_h)^5 of each ray.
  Real own_weight;        ///< Weight of the pixel's own ray.
  Real pixels;            ///< Sum of the weights of the pixels whose rays were taken.
  Real fitting;           ///< Part of `pixels` whose lobes match the receiver's.
  Real3 brightest;        ///< The part of `light` from the ray that brought the most.
  Real brightest_weight;  ///< Its part of `weight`.
  Real squared_weights;   ///< Sum of the rays' squared weights.
  Real squares;           ///< Sum of the squared luminances that rays add, over their weights.
};

/// Sums over no ray.
LAMBENT_REAL_FN CoatSums no_coat_sums() {
  CoatSums none = {Real3(0.0f), Real3(0.0f), 0.0f, 0.0f, 0.0f, 0.0f,
                   0.0f,        Real3(0.0f), 0.0f, 0.0f, 0.0f};
  return none;
}

/// Walter et al. 2007, Eq. 33, as a function of the half vector. Exact for the narrowest lobes,
/// too, for which the cosine alone rounds to 1.
LAMBENT_REAL_FN Real ggx_density(Real3 normal, Real3 h, Real squared_alpha) {
  Real cosine = dot(normal, h);
  Real3 sine = cross(normal, h);
  Real d = cosine * cosine * squared_alpha + dot(sine, sine);
  return squared_alpha * kInvPi / (d * d);
}

LAMBENT_REAL_FN LobeValue coat_lobe(CoatLobe of, Real3 direction_ws) {
  Real3 h = normalize(of.to_viewer_ws + direction_ws);
  Real n_dot_l = dot(of.normal_ws, direction_ws);
  Real density = ggx_density(of.normal_ws, h, of.squared_alpha) * of.pdf_scale;
  Real masked = 1.0f + of.lambda;
  LobeValue lobe;
  lobe.pdf = select(n_dot_l * of.pdf_scale > 0.0f, density, 0.0f);
  lobe.value = lobe.pdf * masked / (masked + smith_lambda(n_dot_l, of.squared_alpha));
  lobe.v_dot_h = select(lobe.pdf > 0.0f, dot(of.to_viewer_ws, h), 0.0f);
  return lobe;
}

/// The direction from `position_ws` to the end of a ray that starts at `origin_ws`.
LAMBENT_REAL_FN Real3 direction_to_end(Real3 position_ws, Real3 origin_ws, CoatRay ray) {
  Real3 to_end = ray.direction_ws * ray.distance + (origin_ws - position_ws);
  return select(left_scene(ray.distance), ray.direction_ws, normalize(to_end));
}

/// Adds the light of a ray with a weight, given the receiver's lobe for its direction. What direct
/// light samples, too, is also multiplied by the multiple importance sampling weight that a ray of
/// the receiver's own lobe has: its direct light has the rest.
LAMBENT_REAL_FN void add_light_of_ray(CoatReceiver at, LobeValue lobe, Real3 direction_ws,
                                      CoatRay ray, Real weight, LAMBENT_INOUT(CoatSums) sums) {
  Real above = select(dot(at.lobe.geometric_normal_ws, direction_ws) > 0.0f, weight, 0.0f);
  Real power = schlick_power(lobe.v_dot_h);
  Real3 reflected = schlick_reflectance(at.reflectance.f0, at.reflectance.f90, power) * above;
  Real3 light = reflected * ray.radiance;
  sums.light += light;
  Real gain = luminance(light) - luminance(sums.brightest);
  sums.brightest = select(gain > 0.0f, light, sums.brightest);
  sums.brightest_weight = select(gain > 0.0f, weight, sums.brightest_weight);
  Real density = sampled_density(ray.apart_luminance, at.density_scale);
  Real3 emission = reflected * (ray.apart * found_light_weight(lobe.pdf, density));
  sums.emission += emission;
  Real level = luminance(light + emission);
  sums.squared_weights += weight * weight;
  sums.squares += level * level / max(weight, kLeastPixelWeight);
}

/// Adds the light of a neighbour's ray, and the weight of the receiver's own ray beside it.
///
/// A ray's end is seen from both pixels: both lobes could have drawn it. The receiver's one ray is
/// shared out among all neighbours, and each pair has the weights of the balance heuristic, which
/// are bounded (pairwise multiple importance sampling: Bitterli, "Correlations and Reuse for Fast
/// and Accurate Physically Based Light Transport", 2022, ch. 9). Lobes that hardly overlap
/// therefore hardly affect each other.
LAMBENT_REAL_FN void add_coat_ray(CoatReceiver at, CoatLobe from, CoatRay ray, Real weight,
                                  LAMBENT_INOUT(CoatSums) sums) {
  Real cosine = dot(at.lobe.geometric_normal_ws, from.geometric_normal_ws);
  Real off_plane = dot(at.lobe.geometric_normal_ws, from.position_ws - at.lobe.position_ws);
  // Rays of mirrors do not include what is stored in CoatRay::mirrored, nor those of sharp ones
  // what is in ShownBase
  Real here = select(at.lobe.squared_alpha > kMirrorAlpha * kMirrorAlpha, 1.0f, 0.0f) +
              select(at.lobe.squared_alpha > kSharpMirrorAlpha * kSharpMirrorAlpha, 1.0f, 0.0f);
  Real there = select(from.squared_alpha > kMirrorAlpha * kMirrorAlpha, 1.0f, 0.0f) +
               select(from.squared_alpha > kSharpMirrorAlpha * kSharpMirrorAlpha, 1.0f, 0.0f);
  Real alike = 1.0f - (here - there) * (here - there);
  Real similar = alike * weight * relit_weight(cosine, off_plane * at.inverse_tolerance);
  Real pixel = select(similar >= kLeastPixelWeight, similar, 0.0f);
  if (all_zero(pixel)) return;
  sums.pixels += pixel;

  // Compute how well the neighbour's lobe fits, and the weight of the receiver's own ray
  Real fitting = coat_lobe(from, at.mirror_ws).pdf * at.inverse_mirror_pdf;
  sums.fitting += pixel * min(fitting, 1.0f);
  Real3 own_end = direction_to_end(from.position_ws, at.lobe.position_ws, at.own);
  Real own_pdf = coat_lobe(from, own_end).pdf + kOwnShare * at.at_own.pdf;
  Real own_value = pixel * kOwnShare * at.at_own.value;
  sums.own_weight += select(own_value > 0.0f, own_value / own_pdf, 0.0f);

  // Weigh the neighbour's ray by the receiver's lobe
  Real3 direction = direction_to_end(at.lobe.position_ws, from.position_ws, ray);
  LobeValue lobe = coat_lobe(at.lobe, direction);
  Real balanced = lobe.value / (ray.pdf + kOwnShare * lobe.pdf);
  Real alone = min(lobe.value / ray.pdf, kMaxReuseWeight);
  Real ray_weight = pixel * select(at.own.pdf != 0.0f, balanced, alone);
  ray_weight = select(min(ray.pdf, lobe.value) > 0.0f, ray_weight, 0.0f);
  if (all_zero(ray_weight)) return;
  sums.weight += ray_weight;
  sums.schlick += ray_weight * schlick_power(lobe.v_dot_h);
  add_light_of_ray(at, lobe, direction, ray, ray_weight, sums);
}
