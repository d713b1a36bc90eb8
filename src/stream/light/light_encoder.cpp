// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "field/field_access.h"
#include "field/field_state.h"
#include "lambent/stream.h"
#include "stream/light/geometry_coding.h"
#include "stream/light/light_coding.h"
#include "stream/light/message.h"
#include "stream/light/quantise.h"
#include "stream/textures/texture_encoding.h"

namespace lambent::stream {
namespace {

// Each update compares the distances of one in this many probes with those that were sent.
constexpr int kDistanceTurns = 4;

// The controller of errors. It aims at this share of the target, and an update in which an error is
// above the target is coded again with a smaller thrift, and at last as a key.
constexpr double kAim = 0.97;
constexpr float kMaxThrift = 2.0f, kLeastThrift = 0.05f, kThriftStep = 0.7f;
// From one update to the next, the thrift is multiplied by aim over error, raised to this power.
constexpr double kThriftPower = 2.0;

// A key's unit is chosen for errors of at most this share of the target, so that light may become
// darker before the next key is needed.
constexpr double kKeyAim = 0.8;
// If errors are below this share of the target despite the largest thrift, a key with a larger unit
// pays off by smaller deltas.
constexpr double kTooExact = 0.4;
// Light that is brighter or darker than at the last key by this factor needs a new key at once.
constexpr double kOtherLight = 16.0;

// The noise of corrections falls with the root of the number of updates: they are sent again when
// that number has grown by kCorrectionsGrowth, but after at most 3 * kCorrectionsAtLeast updates.
constexpr int kCorrectionsGrowth = 4, kCorrectionsAtLeast = 4096, kFirstCorrections = 4;

/// The update of a field with which corrections are sent again.
int due_after(int updates) {
  return updates + std::clamp((kCorrectionsGrowth - 1) * std::min(updates, kCorrectionsAtLeast),
                              kFirstCorrections, kCorrectionsAtLeast);
}

double largest(const LightErrors& errors) {
  return std::max(errors.relative, errors.dark);
}

}  // namespace

struct LightEncoder::State {
  LightEncoderSettings settings;
  FieldGeometry geometry;
  std::uint64_t geometry_version = 0;
  LightLayout layout;
  std::optional<TileBasis> basis;  // empty before the first update
  LightState light;
  double key_mean = 0.0;  // mean light at the last key [W/m^2]
  float thrift = 1.0f;
  LightErrors errors;
  std::optional<TextureEncoding> textures;  // empty: Lambent's own codec
  bool refreshes = false;                   // the next texture is a key

  // Coded geometry for clients that join late, as long as it is valid
  mutable std::mutex coded_mutex;
  mutable GeometrySections sections;
  mutable CorrectionPieces pieces;

  int next_corrections = 0;  // the number of the field's update with which they are sent again

  MessageHeader header(LightMessageKind kind, std::uint64_t update) const {
    return {kind, settings.stream, update, geometry_version};
  }

  void begin_geometry(const IrradianceField& field, std::uint64_t update) {
    geometry = geometry_of(field);
    next_corrections = due_after(field.updates());
    geometry_version = geometry_number(settings.stream, update);
    geometry.corrections_number = geometry_version;
    sections.clear();
    pieces.clear();
    layout = layout_of(geometry);
    basis.emplace(geometry.irradiance_texels);
    light = LightState{};
  }

  /// All of the geometry, for clients that have none. Sections that have not changed are not coded
  /// again.
  std::vector<LightMessage> whole_geometry(std::uint64_t update) const {
    const std::scoped_lock lock(coded_mutex);
    return geometry_messages(header(LightMessageKind::geometry, update), geometry, sections);
  }

  void take_corrections(const IrradianceField& field) {
    geometry.corrections = corrections_of(field);
    pieces.clear();
    next_corrections = due_after(field.updates());
  }

  /// A message with the changes of the geometry, if any.
  std::optional<LightMessage> follow_geometry(const IrradianceField& field, std::uint64_t update);

  LightMessage encode_light(const FieldLight& field, std::uint64_t update);
  Expected<LightMessage> encode_texture(const FieldLight& field, std::uint64_t update);
  LightMessage encode_key(const FieldLight& field, std::uint64_t update, float unit);

  LightMessage key() const {
    return make_message(header(LightMessageKind::key, light.update), write_key(layout, light));
  }
};

std::optional<LightMessage> LightEncoder::State::follow_geometry(const IrradianceField& field,
                                                                 std::uint64_t update) {
  const FieldGeometry kind = kind_of(field);
  const bool moved =
      !std::equal(kind.volumes.begin(), kind.volumes.end(), geometry.volumes.begin(),
                  [](const Volume& a, const Volume& b) { return same_place(a.grid, b.grid); });
  // Compare all probes after scrolling, since recycled ones have distances of other places
  const int turns = moved ? 1 : kDistanceTurns;
  const UpdatedProbes updated =
      follow(field, settings.distance_threshold, static_cast<int>(update % turns), turns, geometry);
  const bool corrects = field.updates() >= next_corrections;
  if (corrects) take_corrections(field);
  if (updated.probes.empty() && !moved && !corrects) return std::nullopt;
  const std::uint64_t base = geometry_version;
  geometry_version = geometry_number(settings.stream, update);
  if (corrects) geometry.corrections_number = geometry_version;
  forget_sections(updated.probes, sections);
  layout = layout_of(geometry);
  clear_unlit(layout, light);
  return make_message(header(LightMessageKind::geometry, update),
                      geometry_body(base, write_changes(updated, geometry, corrects)));
}

LightMessage LightEncoder::State::encode_key(const FieldLight& field, std::uint64_t update,
                                             float unit) {
  constexpr int kTries = 8;
  for (int i = 0; i < kTries; ++i) {
    light = rounded_state(layout, coefficients_of(layout, *basis, field, unit), unit);
    errors = errors_of(layout, *basis, field, unit, light.coefficients);
    const double too_large = largest(errors) / (kKeyAim * settings.target_error);
    if (too_large <= 1.0) break;
    unit = std::max(unit * static_cast<float>(0.95 / too_large), kLeastUnit);
  }
  light.update = update;
  key_mean = field.mean;
  thrift = 1.0f;
  return key();
}

LightMessage LightEncoder::State::encode_light(const FieldLight& field, std::uint64_t update) {
  const bool other_light =
      field.mean > kOtherLight * key_mean || key_mean > kOtherLight * field.mean;
  if (light.update == 0 || other_light) {
    return encode_key(field, update, choose_unit(field, settings.target_error));
  }
  const std::vector<float> wanted = coefficients_of(layout, *basis, field, light.unit);
  for (bool again = true; again;) {
    const std::vector<std::int32_t> levels = choose_levels(layout, light, wanted, thrift);
    std::vector<std::int32_t> now(light.coefficients);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] += levels[i];
    errors = errors_of(layout, *basis, field, light.unit, now);
    const double share = largest(errors) / settings.target_error;
    if (share <= 1.0) {
      if (share < kTooExact && thrift >= kMaxThrift) break;
      std::vector<std::byte> body = write_delta(layout, levels, light);
      thrift = std::clamp(
          thrift * static_cast<float>(std::pow(kAim / std::max(share, 0.5), kThriftPower)),
          kLeastThrift, kMaxThrift);
      return make_message(header(LightMessageKind::delta, update), body);
    }
    again = thrift > 0.0f;
    thrift = thrift > kLeastThrift ? std::max(thrift * kThriftStep, kLeastThrift) : 0.0f;
  }
  const double share = std::max(largest(errors) / settings.target_error, 0.1);
  return encode_key(field, update, light.unit * static_cast<float>(kKeyAim / share));
}

Expected<LightMessage> LightEncoder::State::encode_texture(const FieldLight& field,
                                                           std::uint64_t update) {
  const bool key = std::exchange(refreshes, false) || light.update == 0;
  auto encoded = textures->encode(geometry, layout, *basis, field, settings.target_error, key);
  if (!encoded) return tl::unexpected(encoded.error());
  light = std::move(encoded->light);
  light.update = update;
  errors = encoded->errors;
  const auto kind = encoded->is_key ? LightMessageKind::texture_key : LightMessageKind::texture;
  return make_message(header(kind, update), encoded->body);
}

LightEncoder::LightEncoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
LightEncoder::~LightEncoder() = default;
LightEncoder::LightEncoder(LightEncoder&&) noexcept = default;
LightEncoder& LightEncoder::operator=(LightEncoder&&) noexcept = default;

Expected<LightEncoder> LightEncoder::create(const LightEncoderSettings& settings) {
  constexpr float kLeastError = 0.001f, kMostError = 0.2f, kLeastThreshold = 0.001f;
  if (!(settings.target_error >= kLeastError && settings.target_error <= kMostError)) {
    return fail("", "target error", "must be 0.001 to 0.2");
  }
  if (!(settings.distance_threshold >= kLeastThreshold && settings.distance_threshold <= 1.0f)) {
    return fail("", "distance threshold", "must be 0.001 to 1");
  }
  auto state = std::make_unique<State>();
  state->settings = settings;
  return LightEncoder(std::move(state));
}

Expected<LightEncoder> LightEncoder::create(const LightEncoderSettings& settings,
                                            std::unique_ptr<TextureWriter> writer) {
  auto encoder = create(settings);
  if (encoder) encoder->state_->textures.emplace(std::move(writer));
  return encoder;
}

void LightEncoder::refresh() {
  state_->refreshes = true;
}

Expected<std::vector<LightMessage>> LightEncoder::encode(const IrradianceField& field) {
  State& s = *state_;
  const FieldAccess::State& of_field = FieldAccess::state_of(field);
  of_field.backend->fetch_light();
  const std::span<const glm::vec4> tiles(of_field.data.light);
  const std::uint64_t update = s.light.update + 1;
  if (const auto fine = check_light(tiles); !fine) return tl::unexpected(fine.error());
  std::vector<LightMessage> messages;
  if (!s.basis || !s.geometry.same_kind(kind_of(field))) {
    s.begin_geometry(field, update);
    messages = s.whole_geometry(update);
  } else if (std::optional<LightMessage> changes = s.follow_geometry(field, update)) {
    messages.push_back(std::move(*changes));
  }
  const FieldLight light = measure_light(s.layout, tiles);
  if (!s.textures) {
    messages.push_back(s.encode_light(light, update));
    return messages;
  }
  Expected<LightMessage> texture = s.encode_texture(light, update);
  if (!texture) return tl::unexpected(texture.error());
  messages.push_back(std::move(*texture));
  return messages;
}

Expected<std::vector<LightMessage>> LightEncoder::join(std::uint64_t known_geometry) const {
  const State& s = *state_;
  if (s.light.update == 0)
    return fail("light stream", "", "holds no light before its first update");
  std::vector<LightMessage> messages;
  if (known_geometry != s.geometry_version) messages = s.whole_geometry(s.light.update);
  if (!s.textures) messages.push_back(s.key());
  return messages;
}

std::vector<LightMessage> LightEncoder::corrections() const {
  const State& s = *state_;
  const std::scoped_lock lock(s.coded_mutex);
  write_pieces(s.geometry.corrections, s.pieces);
  return correction_messages(s.settings.stream, s.light.update, s.geometry.corrections_number,
                             s.pieces);
}

std::uint64_t LightEncoder::geometry() const {
  return state_->geometry_version;
}

std::uint64_t LightEncoder::corrections_number() const {
  return state_->geometry.corrections_number;
}

std::uint64_t LightEncoder::update() const {
  return state_->light.update;
}

LightErrors LightEncoder::errors() const {
  return state_->errors;
}

}  // namespace lambent::stream
