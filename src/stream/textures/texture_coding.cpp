// SPDX-License-Identifier: Apache-2.0
#include "stream/textures/texture_coding.h"

#include <cmath>

#include "core/little_endian.h"
#include "stream/light/light_signal.h"
#include "stream/light/message.h"

namespace lambent::stream {

std::vector<std::byte> write_texture(float scale,
                                     std::span<const std::vector<std::byte>> pictures) {
  ByteWriter out;
  out.f32(scale);
  out.u32(static_cast<std::uint32_t>(pictures.size()));
  for (const std::vector<std::byte>& picture : pictures) {
    out.u32(static_cast<std::uint32_t>(picture.size()));
    out.raw(picture);
  }
  return out.take();
}

Expected<TextureBody> read_texture(std::span<const std::byte> body) {
  const auto is_short = [] { return bad_stream("texture", "is cut short"); };
  ByteReader in(body);
  if (in.left() < 2 * sizeof(std::uint32_t)) return is_short();
  TextureBody texture;
  texture.scale = in.f32();
  // Written so that NaN fails
  if (!(texture.scale >= kLeastUnit * kTextureUnits && texture.scale <= kMaxUnit)) {
    return bad_stream("texture", "has a scale out of range");
  }
  const std::uint32_t count = in.u32();
  if (count == 0 || count > kMaxTexturePictures) {
    return bad_stream("texture", "has a number of pictures out of range");
  }
  std::span<const std::byte> rest = body.subspan(2 * sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < count; ++i) {
    if (rest.size() < sizeof(std::uint32_t)) return is_short();
    const std::size_t size = ByteReader(rest).u32();
    rest = rest.subspan(sizeof(std::uint32_t));
    if (rest.size() < size) return is_short();
    texture.pictures.push_back(rest.first(size));
    rest = rest.subspan(size);
  }
  if (!rest.empty()) return bad_stream("texture", "goes on after its end");
  return texture;
}

LightState state_of(const TextureAtlas& atlas, const LightLayout& layout, const TileBasis& basis,
                    const TexturePicture& shown, float scale) {
  const std::vector<glm::vec4> tiles = atlas.tiles_of(shown, scale);
  const std::size_t texels = basis.size();
  LightState state;
  state.unit = scale / kTextureUnits;
  state.coefficients.resize(layout.probes() * layout.numbers());
  state.history.resize(layout.probes());
  const LightSignal signal(basis, state.unit);
  std::vector<float> exact(layout.numbers());
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] == 0) continue;
    signal.coefficients_of(std::span(tiles).subspan(probe * texels, texels), exact);
    std::int32_t* own = &state.coefficients[probe * layout.numbers()];
    for (std::size_t i = 0; i < exact.size(); ++i) {
      own[i] = static_cast<std::int32_t>(std::lround(exact[i]));
    }
  }
  return state;
}

}  // namespace lambent::stream
