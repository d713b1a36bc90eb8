// SPDX-License-Identifier: Apache-2.0
// Thin films: their colours against sums over the spectrum, and what they leave to the coat's other
// formulas.
#include "shared/thin_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "shared/color.h"

namespace lambent::thin_film_test {
namespace {

using std::numbers::pi;

/// A Gaussian of another width on each side of its peak.
double lobe(double nm, double peak, double below, double above) {
  const double t = (nm - peak) / (nm < peak ? below : above);
  return std::exp(-0.5 * t * t);
}

/// CIE 1931 colour-matching functions: Wyman, Sloan and Shirley, "Simple Analytic Approximations to
/// the CIE XYZ Color Matching Functions", JCGT 2(2), 2013.
glm::dvec3 matching(double nm) {
  return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
              0.065 * lobe(nm, 501.1, 20.4, 26.2),
          0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
          1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

/// Rec. 709 of a spectrum under light of equal energy, scaled so that 1 everywhere is white.
template <class Spectrum>
vec3 color_of(Spectrum spectrum) {
  const glm::dmat3 to_rgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259,
                          -0.4985314, 0.0415560, 1.0572252);
  glm::dvec3 sum(0.0), white(0.0);
  for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
    sum += matching(nm) * spectrum(nm);
    white += matching(nm);
  }
  return vec3((to_rgb * (sum / white)) / (to_rgb * glm::dvec3(1.0)));
}

/// Reflectance of a dielectric film on a dielectric for unpolarised light of one wavelength, with
/// all orders of interference: Airy's sum.
double airy(double film_ior, double base_ior, double thickness_nm, double cosine, double nm) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double in_film = std::sqrt(1.0 - sine * sine / (film_ior * film_ior));
  const double in_base = std::sqrt(1.0 - sine * sine / (base_ior * base_ior));
  const std::complex<double> turn =
      std::polar(1.0, 4.0 * pi * film_ior * thickness_nm * in_film / nm);
  const auto reflected = [&turn](double outer, double inner) {
    return std::norm((outer + inner * turn) / (1.0 + outer * inner * turn));
  };
  const double s = reflected(
      (cosine - film_ior * in_film) / (cosine + film_ior * in_film),
      (film_ior * in_film - base_ior * in_base) / (film_ior * in_film + base_ior * in_base));
  const double p = reflected(
      (film_ior * cosine - in_film) / (film_ior * cosine + in_film),
      (base_ior * in_film - film_ior * in_base) / (base_ior * in_film + film_ior * in_base));
  return 0.5 * (s + p);
}

vec3 dielectric(float ior) {
  return vec3(normal_reflectance(ior, 1.0f));
}

TEST(ThinFilm, InterferesAsSumsOverTheSpectrumDo) {
  // The two fits of the colour-matching functions differ by up to 0.087 of amplitudes up to 1.3; at
  // longer ways by twice as much
  constexpr float kFit = 0.1f;
  for (float opd = 0.0f; opd <= 1300.0f; opd += 50.0f) {
    for (const float shift : {0.0f, 1.0f, kPi}) {
      const vec3 summed = color_of(
          [&](double nm) { return std::cos(2.0 * pi * opd / nm + static_cast<double>(shift)); });
      const vec3 fitted = film_interference(opd, vec3(shift));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(fitted[c], summed[c], kFit) << opd << " " << shift;
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(film_interference(0.0f, vec3(0.0f))[c], 1.0f, 0.002f);
}

TEST(ThinFilm, ReflectsAsAirysSumOverDielectrics) {
  float worst = 0.0f;
  for (const float film_ior : {1.33f, 1.8f}) {
    for (const float base_ior : {1.5f, 2.4f}) {
      for (float thickness = 100.0f; thickness <= 800.0f; thickness += 50.0f) {
        for (const float cosine : {1.0f, 0.9f, 0.7f, 0.5f}) {
          const vec3 exact =
              color_of([&](double nm) { return airy(film_ior, base_ior, thickness, cosine, nm); });
          const vec3 ours =
              film_reflectance({1.0f, film_ior, thickness}, dielectric(base_ior), cosine);
          for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(ours[c] - exact[c]));
        }
      }
    }
  }
  std::printf("largest error of a reflectance %.4f\n", static_cast<double>(worst));
  // Of this, the fits of the colour-matching functions and Schlick's formula are the causes
  EXPECT_LT(worst, 0.06f);
}

TEST(ThinFilm, OfNoThicknessIsNone) {
  for (const float cosine : {1.0f, 0.6f, 0.3f}) {
    for (const float f0 : {0.04f, 0.3f, 0.9f}) {
      const float bare = f0 + (1.0f - f0) * schlick_power(cosine);
      const vec3 filmed = film_reflectance({1.0f, 1.8f, 0.0f}, vec3(f0), cosine);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(filmed[c], bare, 1e-4f) << f0 << " " << cosine;
    }
  }
}

TEST(ThinFilm, ReflectsAtTheMirrorsAngleWhatTheFilmDoes) {
  Reflectance bare = {vec3(0.2f), 0.01f, vec3(0.04f), 1.0f, no_layers(), 1.0f};
  for (const float cosine : {1.0f, 0.8f, 0.6f, 0.4f}) {
    const ThinFilm film = {0.5f, 1.8f, 420.0f};
    Reflectance filmed = bare;
    put_film(filmed, film, cosine);
    const vec3 expected =
        mix(fresnel(bare, cosine), film_reflectance(film, bare.f0, cosine), film.share);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(fresnel(filmed, cosine)[c], expected[c], 1e-4f) << cosine;
      EXPECT_GE(filmed.f0[c], 0.0f);
      EXPECT_LE(filmed.f0[c], 1.0f);
    }
  }
}

TEST(ThinFilm, LeavesExactLambertSurfacesAndGrazingViewsAlone) {
  const Reflectance lambert = {vec3(0.5f), 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f};
  Reflectance filmed = lambert;
  put_film(filmed, {1.0f, 1.8f, 420.0f}, 0.7f);
  EXPECT_EQ(filmed.f0, lambert.f0);
  Reflectance coat = {vec3(0.2f), 0.01f, vec3(0.04f), 1.0f, no_layers(), 1.0f};
  put_film(coat, {1.0f, 1.8f, 420.0f}, 0.001f);
  EXPECT_EQ(coat.f0, vec3(0.04f));
}

TEST(ThinFilm, IsFiniteForAllThatAFileMayAskFor) {
  for (const float ior : {1.0f, 1.3f, 1e6f}) {
    for (const float thickness : {0.0f, 15.0f, 400.0f, 1e6f}) {
      for (const float f0 : {0.0f, 0.04f, 1.0f}) {
        for (const float cosine : {0.0f, 0.001f, 0.5f, 1.0f}) {
          Reflectance coat = {vec3(0.2f), 0.01f, vec3(f0), 1.0f, no_layers(), 1.0f};
          put_film(coat, {1.0f, ior, thickness}, cosine);
          for (int c = 0; c < 3; ++c) {
            EXPECT_GE(coat.f0[c], 0.0f) << ior << " " << thickness << " " << f0 << " " << cosine;
            EXPECT_LE(coat.f0[c], 1.0f) << ior << " " << thickness << " " << f0 << " " << cosine;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace lambent::thin_film_test
