// SPDX-License-Identifier: Apache-2.0
#include "stream/textures/texture_encoding.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lambent::stream {
namespace {

// Factors of the scale over the root of the brightest light: kRoom for a new scale, and the ratio
// of brightest light to scale below which a new one is needed.
constexpr float kRoom = 1.25f, kTooSmall = 0.4f;

// Errors aim at this share of the target.
constexpr double kAim = 0.93;
// In theory, six steps of the quantiser halve the error.
constexpr double kStepsOfHalf = 6.0;
// Share of the quantiser's difference from its ideal value by which an update changes it.
constexpr double kStep = 0.5;
constexpr double kLeastQuantiser = 0.0, kMostQuantiser = 45.0;
// Least decrease of the quantiser for a picture that refines the one before.
constexpr double kRefine = 3.0;
// If kMostVain successive pictures with a quantiser up to kFine each remove less than kLeastGain of
// the error, the limit of 10 bits is reached. A single one does not show this, since errors do not
// fall evenly with the quantiser.
constexpr double kFine = 8.0, kLeastGain = 0.02;
constexpr int kMostVain = 2;

}  // namespace

/// Chooses a new scale if the last one no longer fits; returns whether it did.
bool TextureEncoding::fit_scale(const FieldLight& light) {
  float most = 0.0f;
  for (const glm::vec4& texel : light.tiles) {
    most = std::max({most, texel.x, texel.y, texel.z});
  }
  const float root = std::max(std::sqrt(most), kLeastUnit * kTextureUnits);
  if (scale_ > 0.0f && root <= scale_ && root >= kTooSmall * scale_) return false;
  scale_ = root * kRoom;
  return true;
}

Expected<TextureEncoding::Encoded> TextureEncoding::encode(const FieldGeometry& geometry,
                                                           const LightLayout& layout,
                                                           const TileBasis& basis,
                                                           const FieldLight& light, float target,
                                                           bool key) {
  const auto atlas = TextureAtlas::of(geometry);
  if (!atlas) return tl::unexpected(atlas.error());
  Encoded encoded;
  encoded.is_key = fit_scale(light) || key || picture_.width != atlas->width() ||
                   picture_.height != atlas->height();
  atlas->draw(layout, light.tiles, scale_, picture_);
  std::vector<std::vector<std::byte>> pictures;
  double first_share = 0.0, last_share = 0.0;
  int vain = 0;
  for (double quantiser = quantiser_;;) {
    const bool begins = encoded.is_key && pictures.empty();
    auto bytes = writer_->write(picture_, begins, static_cast<int>(std::lround(quantiser)), shown_);
    if (!bytes) return tl::unexpected(bytes.error());
    pictures.push_back(std::move(*bytes));
    encoded.light = state_of(*atlas, layout, basis, shown_, scale_);
    encoded.errors =
        errors_of(layout, basis, light, encoded.light.unit, encoded.light.coefficients);
    const double share = std::max(encoded.errors.relative, encoded.errors.dark) / target;
    if (pictures.size() == 1) first_share = share;
    if (share <= 1.0 || pictures.size() == kMaxTexturePictures) break;
    if (quantiser <= kLeastQuantiser) break;
    const bool gained = pictures.size() == 1 || share <= (1.0 - kLeastGain) * last_share;
    vain = quantiser < kFine && !gained ? vain + 1 : 0;
    if (vain == kMostVain) break;
    last_share = share;
    quantiser =
        std::max(quantiser - std::max(kRefine, kStepsOfHalf * std::log2(share)), kLeastQuantiser);
  }
  const double wanted = kStepsOfHalf * std::log2(kAim / std::max(first_share, 0.01));
  quantiser_ = std::clamp(quantiser_ + kStep * wanted, kLeastQuantiser, kMostQuantiser);
  encoded.body = write_texture(scale_, pictures);
  return encoded;
}

}  // namespace lambent::stream
