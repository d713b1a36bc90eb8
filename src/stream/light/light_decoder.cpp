// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include "core/little_endian.h"
#include "lambent/stream.h"
#include "stream/light/decoder_state.h"
#include "stream/light/light_coding.h"
#include "stream/light/message.h"
#include "stream/textures/texture_coding.h"

namespace lambent::stream {
namespace {

std::string of_update(std::uint64_t update) {
  return "update " + std::to_string(update);
}

}  // namespace

Expected<void> LightDecoder::State::receive(std::span<const std::byte> bytes) {
  const Expected<OpenedMessage> message = open_message(bytes);
  if (!message) return tl::unexpected(message.error());
  corrected = false;
  switch (message->header.kind) {
    case LightMessageKind::geometry:
      return receive_geometry(*message);
    case LightMessageKind::key:
      return receive_key(*message);
    case LightMessageKind::delta:
      return receive_delta(*message);
    case LightMessageKind::texture_key:
    case LightMessageKind::texture:
      return receive_texture(*message);
    case LightMessageKind::regions:
      return receive_regions(*message);
    case LightMessageKind::corrections:
      return receive_corrections(*message);
  }
  return bad_stream("", "holds a message of an unknown kind");
}

Expected<void> LightDecoder::State::check_follows(const MessageHeader& header,
                                                  std::uint64_t base_geometry) {
  if (!current || header.stream != current->stream) {
    lost = true;
    return bad_stream(of_update(header.update), "changes a state of which there is no key");
  }
  if (header.update <= light.update) {
    return bad_stream(of_update(header.update), "comes too late");
  }
  if (header.update != light.update + 1 || base_geometry != current->version) {
    lost = true;
    return bad_stream(of_update(header.update), "follows on something that was lost");
  }
  return {};
}

Expected<void> LightDecoder::State::receive_geometry(const OpenedMessage& message) {
  if (message.body.size() < sizeof(std::uint64_t)) return bad_stream("geometry", "is cut short");
  const std::uint64_t base = ByteReader(message.body).u64();
  const std::span<const std::byte> body = message.body.subspan(sizeof(base));
  if (base == 0) {
    if (next && next->stream == message.header.stream && next->version == message.header.geometry) {
      const auto read = read_geometry(body, most_bytes, *next);
      if (!read) return read;
    } else {
      PartialGeometry geometry;
      const auto read = read_geometry(body, most_bytes, geometry);
      if (!read) return read;
      next.emplace(message.header, std::move(geometry));
      if (current) next->take_corrections(*current);
    }
    if (next->is_whole()) next->lay_out();
    changed.clear();
    return {};
  }
  if (const auto fine = check_follows(message.header, base); !fine) return fine;
  if (message.header.geometry != geometry_number(message.header.stream, message.header.update)) {
    return bad_stream("geometry", "changes at an update that is not its own");
  }
  Expected<GeometryChanges> changes = read_changes(body, most_bytes, current->geometry);
  if (!changes) {
    // Later messages depend on this one
    lost = true;
    return tl::unexpected(changes.error());
  }
  changed = std::move(changes->probes);
  current->version = message.header.geometry;
  current->lay_out();
  forget_sections(changed, sections);
  if (changes->corrections) {
    current->geometry.corrections_number = current->version;
    current->forget_corrections();
  }
  corrected = changes->corrections && current->has_corrections();
  clear_unlit(current->layout, light);
  if (way == Way::regions) regions->follow(current->layout);
  return {};
}

Expected<void> LightDecoder::State::receive_corrections(const OpenedMessage& message) {
  bool taken = false;
  changed.clear();
  for (std::optional<ReceivedGeometry>* of : {&next, &current}) {
    if (!*of || (*of)->stream != message.header.stream ||
        (*of)->geometry.corrections_number != message.header.geometry) {
      continue;
    }
    ReceivedGeometry& geometry = **of;
    const bool had_all = geometry.has_corrections();
    const auto piece =
        read_corrections(message.body, static_cast<std::uint32_t>(geometry.geometry.volumes.size()),
                         geometry.geometry.corrections);
    if (!piece) return tl::unexpected(piece.error());
    geometry.pieces[*piece].assign(message.body.begin(), message.body.end());
    corrected = of == &current && !had_all && geometry.has_corrections();
    taken = true;
  }
  if (taken) return {};
  return bad_stream(of_update(message.header.update), "corrects geometry that is not here");
}

Expected<void> LightDecoder::State::check_way(const MessageHeader& header, Way now) {
  if (way == now) return {};
  lost = true;
  return bad_stream(of_update(header.update), "goes on in another way than its key came");
}

Expected<void> LightDecoder::State::check_key(const MessageHeader& header) {
  if (current && header.stream == current->stream && !lost && header.update < light.update) {
    return bad_stream(of_update(header.update), "comes too late");
  }
  const bool is_of_current =
      current && current->stream == header.stream && current->version == header.geometry;
  if (is_of_next(header) || is_of_current) return {};
  lost = true;
  return bad_stream(of_update(header.update), "is of geometry that is not here");
}

void LightDecoder::State::take_key(const MessageHeader& header, LightState key) {
  corrected = is_of_next(header) && next->has_corrections();
  if (is_of_next(header)) {
    current = std::move(next);
    next.reset();
    sections.clear();
    ++geometries;
  }
  light = std::move(key);
  light.update = header.update;
  lost = false;
  changed.resize(current->layout.probes());
  std::iota(changed.begin(), changed.end(), 0);
}

Expected<void> LightDecoder::State::receive_key(const OpenedMessage& message) {
  const MessageHeader& header = message.header;
  if (const auto fine = check_key(header); !fine) return fine;
  const LightLayout& layout = is_of_next(header) ? next->layout : current->layout;
  Expected<LightState> key = read_key(layout, message.body);
  if (!key) return tl::unexpected(key.error());
  take_key(header, std::move(*key));
  way = Way::coded;
  return {};
}

Expected<void> LightDecoder::State::receive_texture(const OpenedMessage& message) {
  const MessageHeader& header = message.header;
  const bool key = header.kind == LightMessageKind::texture_key;
  if (!reader) return bad_stream("", "comes as textures of a video codec, which is not here");
  const Expected<void> fine = key ? check_key(header) : check_follows(header, header.geometry);
  if (!fine) return fine;
  if (!key) {
    if (const auto same = check_way(header, Way::textures); !same) return same;
  }
  const ReceivedGeometry& of = is_of_next(header) ? *next : *current;
  const auto atlas = TextureAtlas::of(of.geometry);
  const auto body = read_texture(message.body);
  Expected<void> read;
  if (!atlas) read = tl::unexpected(atlas.error());
  if (!body) read = tl::unexpected(body.error());
  for (std::size_t i = 0; read && i < body->pictures.size(); ++i) {
    picture.width = atlas->width();
    picture.height = atlas->height();
    read = reader->read(body->pictures[i], key && i == 0, picture);
  }
  if (!read) {
    // Later pictures depend on this one
    lost = true;
    return read;
  }
  const std::vector<std::int32_t> before = key ? std::vector<std::int32_t>() : light.coefficients;
  take_key(header, state_of(*atlas, of.layout, of.basis, picture, body->scale));
  way = Way::textures;
  if (key) return {};
  const std::size_t numbers = current->layout.numbers();
  std::erase_if(changed, [&](int probe) {
    const auto own = light.coefficients.begin() + static_cast<std::ptrdiff_t>(probe * numbers);
    return std::equal(own, own + static_cast<std::ptrdiff_t>(numbers),
                      before.begin() + static_cast<std::ptrdiff_t>(probe * numbers));
  });
  return {};
}

Expected<void> LightDecoder::State::receive_delta(const OpenedMessage& message) {
  if (current && message.header.stream == current->stream &&
      message.header.geometry != current->version && message.header.update > light.update) {
    lost = true;
    return bad_stream(of_update(message.header.update), "is of geometry that is not here");
  }
  if (const auto fine = check_follows(message.header, message.header.geometry); !fine) return fine;
  if (const auto same = check_way(message.header, Way::coded); !same) return same;
  if (const auto fine = read_delta(current->layout, message.body, light, levels); !fine) {
    lost = true;
    return fine;
  }
  changed.clear();
  const std::size_t numbers = current->layout.numbers();
  for (int probe = 0; probe < current->layout.probes(); ++probe) {
    const auto own = std::span(levels).subspan(probe * numbers, numbers);
    if (std::any_of(own.begin(), own.end(), [](std::int32_t level) { return level != 0; })) {
      changed.push_back(probe);
    }
  }
  return {};
}

LightDecoder::LightDecoder(std::size_t most_bytes) : state_(std::make_unique<State>()) {
  state_->most_bytes = most_bytes;
}
LightDecoder::~LightDecoder() = default;
LightDecoder::LightDecoder(LightDecoder&&) noexcept = default;
LightDecoder& LightDecoder::operator=(LightDecoder&&) noexcept = default;

Expected<void> LightDecoder::receive(std::span<const std::byte> message) {
  return state_->receive(message);
}

void LightDecoder::read_textures(std::unique_ptr<TextureReader> reader) {
  state_->reader = std::move(reader);
}

bool LightDecoder::needs_key() const {
  return state_->lost || !state_->current;
}

std::uint64_t LightDecoder::update() const {
  return state_->light.update;
}

std::uint64_t LightDecoder::geometry() const {
  if (state_->next && state_->next->is_whole()) return state_->next->version;
  return state_->current ? state_->current->version : 0;
}

Expected<std::vector<LightMessage>> LightDecoder::join(std::uint64_t known_geometry) const {
  State& s = *state_;
  if (needs_key() || s.way != State::Way::coded) {
    return bad_stream("", "is incomplete here: nobody can go on from it");
  }
  MessageHeader header{LightMessageKind::geometry, s.current->stream, s.light.update,
                       s.current->version};
  std::vector<LightMessage> messages;
  if (known_geometry != s.current->version) {
    messages = geometry_messages(header, s.current->geometry, s.sections);
  }
  header.kind = LightMessageKind::key;
  messages.push_back(make_message(header, write_key(s.current->layout, s.light)));
  return messages;
}

std::vector<LightMessage> LightDecoder::corrections() const {
  if (!state_->current) return {};
  const ReceivedGeometry& of = *state_->current;
  return correction_messages(of.stream, state_->light.update, of.geometry.corrections_number,
                             of.pieces);
}

std::uint64_t LightDecoder::corrections_number() const {
  return state_->current ? state_->current->geometry.corrections_number : 0;
}

bool LightDecoder::has_corrections() const {
  return !state_->current || state_->current->has_corrections();
}

int LightDecoder::probes() const {
  return state_->current ? state_->current->layout.probes() : 0;
}

int LightDecoder::irradiance_texels() const {
  return state_->current ? state_->current->geometry.irradiance_texels : 0;
}

int LightDecoder::distance_texels() const {
  return state_->current ? state_->current->geometry.distance_texels : 0;
}

std::span<const FieldGrid> LightDecoder::grids() const {
  if (!state_->current) return {};
  return state_->current->grids;
}

std::span<const int> LightDecoder::changed() const {
  return state_->changed;
}

void LightDecoder::irradiance(int probe, std::span<glm::vec3> tile) const {
  const ReceivedGeometry& geometry = *state_->current;
  const std::size_t numbers = geometry.layout.numbers();
  LightSignal(geometry.basis, state_->light.unit)
      .light_of(std::span(state_->light.coefficients).subspan(probe * numbers, numbers), tile);
}

void LightDecoder::distances(int probe, std::span<glm::vec2> tile) const {
  const FieldGeometry& geometry = state_->current->geometry;
  const float longest = max_probe_distance(geometry.grid_of(probe));
  for (std::size_t t = 0; t < geometry.tile(); ++t) {
    tile[t] = decode_moments(geometry.moments[probe * geometry.tile() + t], longest);
  }
}

glm::vec3 LightDecoder::position_ws(int probe) const {
  const FieldGeometry& geometry = state_->current->geometry;
  const ProbeGrid& grid = geometry.grid_of(probe);
  return placed_position(grid, probe_coords(grid, probe),
                         decode_probe_offset(geometry.offsets[probe]));
}

}  // namespace lambent::stream
