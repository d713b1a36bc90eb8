// SPDX-License-Identifier: Apache-2.0
// Light as a stream: a server's irradiance field in small messages, and what clients make of them.
// docs/stream-light.md has the format. What carries the messages is not decided here: they come in
// order, or are lost whole.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "lambent/field.h"

namespace lambent::stream {

enum class LightMessageKind : std::uint8_t {
  geometry = 1,     ///< Places, states and distances of probes: all of them, or those that changed.
  key = 2,          ///< The whole state of light.
  delta = 3,        ///< The change of light from one update to the next.
  texture_key = 4,  ///< The whole state of light, as a picture that decoding can begin with.
  texture = 5,      ///< The state of light, as pictures that follow on those before.
  regions = 6,      ///< Keys and changes of parts of a field, as one client needs them.
  corrections = 7,  ///< A piece of the corrections of lookups: refines light that is there.
};

/// One self-contained piece of a light stream; `bytes` is opaque to whoever carries it.
struct LightMessage {
  LightMessageKind kind = LightMessageKind::delta;
  std::uint64_t update = 0;  ///< The state after this update, from 1, is what it leads to.
  std::vector<std::byte> bytes;
};

/// All tiles of a field as a picture of three planes of 10 bits a pixel, none of them subsampled.
struct TexturePicture {
  int width = 0, height = 0;                         ///< Multiples of 8, at most 8192 [pixels].
  std::array<std::vector<std::uint16_t>, 3> planes;  ///< width * height each, 0 to 1023.
};

/// A video codec that light goes through in place of our own codec: one that a platform has, in
/// hardware perhaps. `LAMBENT_STREAM_H265` has one (stream/textures/h265.h).
class TextureWriter {
 public:
  virtual ~TextureWriter() = default;
  /// Encodes a picture by itself (`key`; of any size) or by those before, at once. `quantiser`: 0
  /// to 51, 6 more halve the exactness. `shown` becomes what decoders show, to the bit.
  virtual Expected<std::vector<std::byte>> write(const TexturePicture& picture, bool key,
                                                 int quantiser, TexturePicture& shown) = 0;
};
class TextureReader {
 public:
  virtual ~TextureReader() = default;
  /// Decodes one picture into `picture`, whose size says what is expected. Bytes may be anything.
  virtual Expected<void> read(std::span<const std::byte> bytes, bool key,
                              TexturePicture& picture) = 0;
};

/// How far decoded irradiance E' is from a field's E, over all texels of all probes that are looked
/// up, and all channels.
struct LightErrors {
  double relative = 0.0;  ///< Root mean square of E' - E, over the mean of E.
  double dark = 0.0;  ///< Root mean square of (E' - E) / (E + 0.1 mean of E): counts dark rooms.
};

struct LightEncoderSettings {
  /// Which stream this is. Clients refuse changes of another one, so that a server that starts
  /// again should draw it anew.
  std::uint32_t stream = 1;
  /// Both LightErrors stay below this in each update, 0.001 to 0.2. Half of it costs about twice
  /// the bytes.
  float target_error = 0.01f;
  /// A probe's distances are sent again where they are off by more than this at root mean square
  /// [probe spacings], 0.001 to 1. Half of it sends the noise of their averages, too.
  float distance_threshold = 0.1f;
};

/// The side of the server: turns the states of one field into messages for any number of clients.
class LightEncoder {
 public:
  /// Fails on settings out of range.
  static Expected<LightEncoder> create(const LightEncoderSettings& settings = {});
  /// The same, but light goes through a video codec: `encode` then gives textures in place of keys
  /// and deltas, and `join` geometry alone, as there is a key for all in the next update only
  /// (`refresh`). Where errors stay above the target after some pictures, they are above it.
  static Expected<LightEncoder> create(const LightEncoderSettings& settings,
                                       std::unique_ptr<TextureWriter> writer);
  /// The next update is a key.
  void refresh();
  ~LightEncoder();
  LightEncoder(LightEncoder&&) noexcept;
  LightEncoder& operator=(LightEncoder&&) noexcept;

  /// What all clients need after an update of the field, in the order in which they must get it:
  /// geometry where it changed, and a delta. The first time, where the field has other volumes than
  /// before, and where light has become so much darker or brighter that changes no longer fit, all
  /// of the geometry or a key instead. Fails on light that is not finite. The same calls give the
  /// same bytes.
  Expected<std::vector<LightMessage>> encode(const IrradianceField& field);

  /// What one client needs that comes late or has lost something: geometry, and a key of the state
  /// after the last update, so that the deltas that follow apply. `known_geometry` is what the
  /// client's LightDecoder::geometry says; geometry is left out where the client has it. Fails
  /// before the first encode. May be called by several threads at once, but not beside encode.
  Expected<std::vector<LightMessage>> join(std::uint64_t known_geometry = 0) const;

  /// What can come later than all else: corrections of lookups, in pieces of some 70 kB that a
  /// client takes in any order, and uses once it has all of them. Clients need these after the
  /// geometry of `join` and wherever `corrections_number` has changed; none where the field has no
  /// corrections. What `encode` gives may come before and between them. To be called as `join` is.
  std::vector<LightMessage> corrections() const;
  /// The number of the geometry after the last update, as LightDecoder::geometry; 0: none.
  std::uint64_t geometry() const;
  /// Which corrections these are: the number of the geometry that they came to be with. 0 before
  /// the first encode.
  std::uint64_t corrections_number() const;

  /// Updates encoded so far.
  std::uint64_t update() const;
  /// How far the state that clients have after the last update is from the field.
  LightErrors errors() const;

 private:
  struct State;
  explicit LightEncoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The side of the client: keeps the state that messages lead to. Needs neither a scene nor a ray
/// tracer. Messages may be anything: what is broken, late, of another stream or out of order is an
/// Error and leaves the state as it was.
class LightDecoder {
 public:
  /// A field whose state would take more memory than this is refused.
  explicit LightDecoder(std::size_t most_bytes = std::size_t{1} << 30u);
  ~LightDecoder();
  LightDecoder(LightDecoder&&) noexcept;
  LightDecoder& operator=(LightDecoder&&) noexcept;

  /// What decodes textures; without, they are refused.
  void read_textures(std::unique_ptr<TextureReader> reader);

  /// Takes one message.
  Expected<void> receive(std::span<const std::byte> message);

  /// Whether there is no light yet, or a change was lost: only what LightEncoder::join returns
  /// helps. The last state remains readable.
  bool needs_key() const;
  /// The update whose light this is, from 1; 0: there is none yet.
  std::uint64_t update() const;
  /// The number of the last geometry received, for LightEncoder::join; 0: none.
  std::uint64_t geometry() const;
  /// As LightEncoder::join, so that whoever hands the stream's messages on can take in who comes
  /// late: the same bytes, as both sides hold the same state. Fails where `needs_key` says so, and
  /// where light comes as textures or by regions.
  Expected<std::vector<LightMessage>> join(std::uint64_t known_geometry = 0) const;
  /// As LightEncoder::corrections, of the pieces that are here.
  std::vector<LightMessage> corrections() const;
  /// As LightEncoder::corrections_number.
  std::uint64_t corrections_number() const;
  /// Whether all pieces of these are here; true where there are none.
  bool has_corrections() const;

  // All below are empty or 0 before the first key.

  int probes() const;
  int irradiance_texels() const;  ///< Along a tile's edge, without gutter.
  int distance_texels() const;
  std::span<const FieldGrid> grids() const;
  /// The probes whose light or distances the last message changed, in ascending order.
  std::span<const int> changed() const;
  /// Irradiance [W/m^2] of a probe's tile without gutter, row after row: irradiance_texels()
  /// squared.
  void irradiance(int probe, std::span<glm::vec3> tile) const;
  /// Mean distance [m] and mean squared distance [m^2], row after row: distance_texels() squared.
  void distances(int probe, std::span<glm::vec2> tile) const;
  glm::vec3 position_ws(int probe) const;

 private:
  friend class StreamedField;
  friend class LightTextures;
  friend class RegionEncoder;
  struct State;
  std::unique_ptr<State> state_;
};

/// A field whose light comes from a stream: what a client renders its own world with.
class StreamedField {
 public:
  explicit StreamedField(std::size_t most_bytes = std::size_t{1} << 30u);
  ~StreamedField();
  StreamedField(StreamedField&&) noexcept;
  StreamedField& operator=(StreamedField&&) noexcept;

  /// LightDecoder::read_textures
  void read_textures(std::unique_ptr<TextureReader> reader);

  /// Takes one message as LightDecoder does, and brings the field up to date. Not to be called
  /// while the field is read.
  Expected<void> receive(std::span<const std::byte> message);
  const LightDecoder& decoder() const;

  /// The field, for Renderer and lookups, on the processor; null before the first key. Stays where
  /// it is afterwards. Not to be updated: its light is the server's.
  const IrradianceField* field() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lambent::stream
