// SPDX-License-Identifier: Apache-2.0
// The field of a client: it has the stream's volumes, and its tiles have the decoded light.
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "field/field_access.h"
#include "field/field_state.h"
#include "lambent/stream.h"
#include "stream/light/decoder_state.h"

namespace lambent::stream {
namespace {

// Stored moments are replaced, not averaged; half floats are dithered with the same seed every
// time.
constexpr float kReplace = 1.0f;
constexpr uint kDitherSeed = 0;

/// Settings of a field with these volumes. Light is stored as float32, as it was decoded.
FieldSettings settings_for(const FieldGeometry& geometry) {
  FieldSettings settings;
  settings.irradiance_texels = geometry.irradiance_texels;
  settings.distance_texels = geometry.distance_texels;
  settings.irradiance_format = IrradianceFormat::float32;
  settings.corrections = false;
  return settings;
}

}  // namespace

struct StreamedField::State {
  LightDecoder decoder;
  FieldGeometry kind;  ///< Volumes and tiles of `field`, without probes.
  std::uint64_t geometry = 0;
  std::optional<IrradianceField> field;

  /// Creates the field, or replaces it if the stream's volumes have changed.
  void make_field(const FieldGeometry& of_stream);
  void copy_places(const FieldGeometry& of_stream);
  void copy_distances(std::span<const int> probes);
  void copy_corrections(const FieldGeometry& of_stream);
  void copy_light(std::span<const int> probes);
};

void StreamedField::State::make_field(const FieldGeometry& of_stream) {
  IrradianceField made = FieldAccess::make(
      std::make_unique<FieldAccess::State>(settings_for(of_stream), of_stream.volumes));
  // Keep the address of the field, for objects that refer to it
  if (field) {
    *field = std::move(made);
  } else {
    field.emplace(std::move(made));
  }
  kind = of_stream;
}

void StreamedField::State::copy_places(const FieldGeometry& of_stream) {
  FieldAccess::State& state = FieldAccess::state_of(*field);
  ProbeStore& store = state.data.store;
  for (int v = 0; v < store.volumes(); ++v) {
    store.move_volume(v, of_stream.volumes[v].grid);
    state.volumes.grids[v] = field_grid(of_stream.volumes[v].grid);
  }
  for (int probe = 0; probe < store.probes(); ++probe) {
    store.set_probe_offset(probe, decode_probe_offset(of_stream.offsets[probe]));
    state.statuses[probe].state = of_stream.states[probe];
  }
}

void StreamedField::State::copy_distances(std::span<const int> probes) {
  ProbeStore& store = FieldAccess::state_of(*field).data.store;
  std::vector<glm::vec2> tile(static_cast<std::size_t>(store.distance_texels()) *
                              store.distance_texels());
  for (const int probe : probes) {
    decoder.distances(probe, tile);
    store.blend_moments(probe, tile, kReplace, kDitherSeed);
  }
}

void StreamedField::State::copy_corrections(const FieldGeometry& of_stream) {
  CorrectionTable& table = FieldAccess::state_of(*field).data.correction;
  table = CorrectionTable(of_stream.probes());
  table.restore(decode_corrections(of_stream.corrections), 1.0f);
}

void StreamedField::State::copy_light(std::span<const int> probes) {
  FieldAccess::State& state = FieldAccess::state_of(*field);
  const auto texels = static_cast<std::size_t>(state.data.tile_texels());
  std::vector<glm::vec3> tile(texels);
  for (const int probe : probes) {
    decoder.irradiance(probe, tile);
    state.data.store.store_irradiance(probe, tile, kDitherSeed);
    for (std::size_t t = 0; t < texels; ++t) {
      state.data.light[probe * texels + t] = glm::vec4(tile[t], 0.0f);
    }
  }
  state.updates = static_cast<int>(decoder.update() & 0x7FFFFFFFu);
}

StreamedField::StreamedField(std::size_t most_bytes) : state_(std::make_unique<State>()) {
  state_->decoder = LightDecoder(most_bytes);
}
StreamedField::~StreamedField() = default;
StreamedField::StreamedField(StreamedField&&) noexcept = default;
StreamedField& StreamedField::operator=(StreamedField&&) noexcept = default;

Expected<void> StreamedField::receive(std::span<const std::byte> message) {
  State& s = *state_;
  if (const auto fine = s.decoder.receive(message); !fine) return fine;
  const LightDecoder::State& decoded = *s.decoder.state_;
  if (!decoded.current) return {};
  const std::span<const int> changed = s.decoder.changed();
  const std::uint64_t version = decoded.current->version;
  if (s.geometry != version) {
    // Changes list the probes that they change; after any other message, all are new
    const bool anew = !s.field || !decoded.current->geometry.same_kind(s.kind);
    if (anew) s.make_field(decoded.current->geometry);
    s.copy_places(decoded.current->geometry);
    s.copy_distances(changed);
    s.geometry = version;
  }
  if (decoded.corrected) s.copy_corrections(decoded.current->geometry);
  s.copy_light(changed);
  return {};
}

void StreamedField::read_textures(std::unique_ptr<TextureReader> reader) {
  state_->decoder.read_textures(std::move(reader));
}

const LightDecoder& StreamedField::decoder() const {
  return state_->decoder;
}

const IrradianceField* StreamedField::field() const {
  return state_->field ? &*state_->field : nullptr;
}

}  // namespace lambent::stream
