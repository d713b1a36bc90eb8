// SPDX-License-Identifier: Apache-2.0
// The colours of a thin film on a surface: the light that its two sides reflect interferes.
//
// Based on: Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of
// Varying Iridescence", SIGGRAPH 2017; Khronos Group, KHR_materials_iridescence.
#ifndef LAMBENT_SHARED_THIN_FILM_H
#define LAMBENT_SHARED_THIN_FILM_H

#include "shared/brdf.h"

LAMBENT_BEGIN

/// A film in air, on a surface.
struct ThinFilm {
  float share;         ///< Share of the surface that it covers, 0 to 1.
  float ior;           ///< Index of refraction, 1 or more.
  float thickness_nm;  ///< [nm], 0 or more.
};

/// From no thickness to this one [nm], a film comes into being: its index of refraction rises from
/// that of air to its own.
const float kFullFilmNm = 30.0f;

/// Largest reflectance from which an index of refraction is found, and largest factor between two
/// orders of interference: both formulas have a pole at 1.
const float kMaxFilmReflectance = 0.9999f;

/// Least part of a reflectance that hangs on that at normal incidence. Where Schlick's power leaves
/// less, the view is so grazing that the film's colours cannot be told.
const float kMinFilmPart = 0.05f;

/// Fresnel reflectance at normal incidence between two media of these indices of refraction.
LAMBENT_FN float normal_reflectance(float ior, float outside) {
  float root = (ior - outside) / (ior + outside);
  return root * root;
}

/// The index of refraction, in air, with this reflectance at normal incidence.
LAMBENT_FN float ior_of_reflectance(float reflectance) {
  float root = sqrt(min(reflectance, kMaxFilmReflectance));
  return (1.0f + root) / (1.0f - root);
}

/// Mean of cos(2 pi opd / wavelength + shift) over the wavelengths that each channel of Rec. 709
/// sees, white being 1, 1, 1. `opd_nm` is an optical path difference [nm]. The numbers are Belcour
/// and Barla's Fourier transforms of Gaussians fitted to the CIE 1931 colour-matching functions
/// [SI]; their white, of equal energy, is then scaled to that of Rec. 709.
LAMBENT_FN vec3 film_interference(float opd_nm, vec3 shift) {
  float phase = kTwoPi * 1e-9f * opd_nm;
  float squared = phase * phase;
  float x = 5.4856e-13f * sqrt(kTwoPi * 4.3278e9f) * cos(1.6810e6f * phase + shift.x) *
                exp(-4.3278e9f * squared) +
            9.7470e-14f * sqrt(kTwoPi * 4.5282e9f) * cos(2.2399e6f * phase + shift.x) *
                exp(-4.5282e9f * squared);
  float y = 4.4201e-13f * sqrt(kTwoPi * 9.3046e9f) * cos(1.7953e6f * phase + shift.y) *
            exp(-9.3046e9f * squared);
  float z = 5.2481e-13f * sqrt(kTwoPi * 6.6121e9f) * cos(2.2084e6f * phase + shift.z) *
            exp(-6.6121e9f * squared);
  // The inverse of IEC 61966-2-1's matrix, each row over its sum
  vec3 rgb = vec3(3.2404542f * x - 1.5371385f * y - 0.4985314f * z,
                  -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
                  0.0556434f * x - 0.2040259f * y + 1.0572252f * z);
  return rgb / (1.0685e-7f * vec3(1.2047843f, 0.9483008f, 0.9088427f));
}

/// Reflectance of a film on a base whose reflectance at normal incidence, without the film, is
/// `base_f0`: Belcour and Barla 2017, Eq. 10, with three orders of interference. Of metals the
/// phase shift is left out, as their complex index is not known.
LAMBENT_FN vec3 film_reflectance(ThinFilm film, vec3 base_f0, float cosine) {
  float t = clamp(film.thickness_nm / kFullFilmNm, 0.0f, 1.0f);
  float present = t * t * (3.0f - 2.0f * t);
  float ior = mix(1.0f, film.ior, present);
  float inside = sqrt(max(1.0f - (1.0f - cosine * cosine) / (ior * ior), 0.0f));
  vec3 base_ior = vec3(ior_of_reflectance(base_f0.x), ior_of_reflectance(base_f0.y),
                       ior_of_reflectance(base_f0.z));

  // The film's two sides
  float outer_f0 = normal_reflectance(ior, 1.0f);
  float outer = outer_f0 + (1.0f - outer_f0) * schlick_power(cosine) * present;
  vec3 inner_f0 = vec3(normal_reflectance(base_ior.x, ior), normal_reflectance(base_ior.y, ior),
                       normal_reflectance(base_ior.z, ior));
  vec3 inner = schlick_reflectance(inner_f0, 1.0f, schlick_power(inside));
  // A denser medium shifts the light that it reflects by half a wave
  vec3 shift = vec3(base_ior.x < ior ? kTwoPi : kPi, base_ior.y < ior ? kTwoPi : kPi,
                    base_ior.z < ior ? kTwoPi : kPi);

  // Orders 0, 1 and 2 of the light that comes back out
  vec3 order = min(outer * inner, vec3(kMaxFilmReflectance));
  vec3 from_inside = (1.0f - outer) * (1.0f - outer) * inner / (vec3(1.0f) - order);
  vec3 amplitude = 2.0f * (from_inside - vec3(1.0f - outer));
  order = sqrt(order);
  float opd_nm = 2.0f * ior * film.thickness_nm * inside;
  vec3 reflected = vec3(outer) + from_inside;
  reflected += amplitude * order * film_interference(opd_nm, shift);
  reflected += amplitude * order * order * film_interference(2.0f * opd_nm, 2.0f * shift);
  return clamp(reflected, vec3(0.0f), vec3(1.0f));
}

/// Puts a film on a surface that is seen at this cosine: the surface's reflectance at normal
/// incidence becomes the one with which Schlick's formula gives the film's reflectance there. All
/// formulas of coats then hold for it. It is exact for mirrors, but for views so grazing that it
/// would be below 0; in wide lobes the colour is that of their middle.
LAMBENT_FN void put_film(LAMBENT_INOUT(Reflectance) surface, ThinFilm film, float n_dot_v) {
  float cosine = clamp(n_dot_v, 0.0f, 1.0f);
  float power = schlick_power(cosine);
  if (film.share <= 0.0f || surface.f90 <= 0.0f || 1.0f - power < kMinFilmPart) return;
  vec3 seen = film_reflectance(film, surface.f0, cosine);
  vec3 f0 = (seen - vec3(surface.f90 * power)) / (1.0f - power);
  surface.f0 = mix(surface.f0, clamp(f0, vec3(0.0f), vec3(1.0f)), film.share);
}

LAMBENT_END
#endif
