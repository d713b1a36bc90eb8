// SPDX-License-Identifier: Apache-2.0
// Light as a stream: a server encodes its irradiance field in small messages, and clients decode
// them. docs/stream-light.md has the format. Any transport may carry the messages, as long as each
// arrives whole and in order, or not at all.
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
  geometry = 1,     ///< Places, states and distances of all probes, or of those that changed.
  key = 2,          ///< The whole state of light.
  delta = 3,        ///< The change of light from one update to the next.
  texture_key = 4,  ///< The whole state of light, as a video picture that decoding can begin with.
  texture = 5,      ///< The state of light, as pictures predicted from earlier ones.
  regions = 6,      ///< Keys and changes of parts of a field, as one client needs them.
  corrections = 7,  ///< A part of the lookup corrections (FieldSettings::corrections).
};

/// One self-contained piece of a light stream; `bytes` is opaque to the transport.
struct LightMessage {
  LightMessageKind kind = LightMessageKind::delta;
  std::uint64_t update = 0;  ///< Decoding it yields the state after this update, counted from 1.
  std::vector<std::byte> bytes;
};

/// All tiles of a field as a picture of three planes of 10 bits a pixel, none of them subsampled.
struct TexturePicture {
  int width = 0, height = 0;                         ///< Multiples of 8, at most 8192 [pixels].
  std::array<std::vector<std::uint16_t>, 3> planes;  ///< width * height each, 0 to 1023.
};

/// A video codec that encodes light in place of Lambent's own codec, such as a platform's hardware
/// codec. `LAMBENT_STREAM_H265` provides one (stream/textures/h265.h).
class TextureWriter {
 public:
  virtual ~TextureWriter() = default;
  /// Encodes a picture without delay: by itself (`key`; of any size) or predicted from those
  /// before. `quantiser`: 0 to 51, 6 more double the step. `shown` becomes the decoded picture, to
  /// the bit.
  virtual Expected<std::vector<std::byte>> write(const TexturePicture& picture, bool key,
                                                 int quantiser, TexturePicture& shown) = 0;
};
class TextureReader {
 public:
  virtual ~TextureReader() = default;
  /// Decodes one picture into `picture`, whose size says what is expected. Bytes are untrusted.
  virtual Expected<void> read(std::span<const std::byte> bytes, bool key,
                              TexturePicture& picture) = 0;
};

/// How far decoded irradiance E' is from a field's E, over all texels of all probes that are looked
/// up, and all channels.
struct LightErrors {
  double relative = 0.0;  ///< Root mean square of E' - E, over the mean of E.
  double dark = 0.0;  ///< Root mean square of (E' - E) / (E + 0.1 mean of E): includes dark rooms.
};

struct LightEncoderSettings {
  /// Identifies the stream. Clients refuse changes of another stream, so a server that restarts
  /// should choose a new number.
  std::uint32_t stream = 1;
  /// Both LightErrors stay below this in each update, 0.001 to 0.2. Halving it costs about twice
  /// the bytes.
  float target_error = 0.01f;
  /// A probe's distances are sent again where their root mean square error exceeds this [probe
  /// spacings], 0.001 to 1. Half of the default sends the noise of their averages, too.
  float distance_threshold = 0.1f;
};

/// The server's side: encodes the states of one field into messages for any number of clients.
class LightEncoder {
 public:
  /// Fails on settings out of range.
  static Expected<LightEncoder> create(const LightEncoderSettings& settings = {});
  /// An encoder whose light goes through a video codec: `encode` then returns textures in place of
  /// keys and deltas, and `join` returns geometry alone; a client that joins can decode light from
  /// the next key on, which `refresh` requests. If errors are still above the target after some
  /// pictures, the update is sent with these errors.
  static Expected<LightEncoder> create(const LightEncoderSettings& settings,
                                       std::unique_ptr<TextureWriter> writer);
  /// Makes the next update a key.
  void refresh();
  ~LightEncoder();
  LightEncoder(LightEncoder&&) noexcept;
  LightEncoder& operator=(LightEncoder&&) noexcept;

  /// The messages that all clients need after an update of the field, in the order in which they
  /// must receive them: geometry where it changed, and a delta. The first time, where the field has
  /// other volumes than before, and where light has become so much darker or brighter that changes
  /// no longer fit, all of the geometry or a key instead. Fails on light that is not finite. The
  /// same calls give the same bytes.
  Expected<std::vector<LightMessage>> encode(const IrradianceField& field);

  /// The messages for one client that joins late or has lost a message: geometry, and a key of the
  /// state after the last update, to which the following deltas apply. `known_geometry` is the
  /// client's LightDecoder::geometry; geometry that the client has is left out. Fails before the
  /// first encode. May be called by several threads at once, but not concurrently with encode.
  Expected<std::vector<LightMessage>> join(std::uint64_t known_geometry = 0) const;

  /// The lookup corrections, which may be sent after everything else, in pieces of some 70 kB. A
  /// client accepts these in any order and uses them once it has all. Clients need them after the
  /// geometry of `join` and whenever `corrections_number` has changed; none where the field has no
  /// corrections. Messages of `encode` may be sent before and between them. Threads may call it as
  /// they may call `join`.
  std::vector<LightMessage> corrections() const;
  /// The number of the geometry after the last update, comparable to LightDecoder::geometry; 0:
  /// none.
  std::uint64_t geometry() const;
  /// The version of the corrections: the number of the geometry with which they first appeared. 0
  /// before the first encode.
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

/// The client's side: decodes messages into the state of a field. Needs neither a scene nor a ray
/// tracer. Messages are untrusted: one that is broken, late, of another stream or out of order is
/// an Error and leaves the state as it was.
class LightDecoder {
 public:
  /// A field whose state would take more memory than this is refused.
  explicit LightDecoder(std::size_t most_bytes = std::size_t{1} << 30u);
  ~LightDecoder();
  LightDecoder(LightDecoder&&) noexcept;
  LightDecoder& operator=(LightDecoder&&) noexcept;

  /// Sets the decoder of textures; without one, textures are refused.
  void read_textures(std::unique_ptr<TextureReader> reader);

  /// Takes one message.
  Expected<void> receive(std::span<const std::byte> message);

  /// Whether there is no light yet, or a change was lost: decoding then continues only from the
  /// messages of LightEncoder::join. The last state remains readable.
  bool needs_key() const;
  /// The update whose light this is, from 1; 0: there is none yet.
  std::uint64_t update() const;
  /// The number of the last geometry received, for LightEncoder::join; 0: none.
  std::uint64_t geometry() const;
  /// The messages that LightEncoder::join would return, so that a relay of the stream can serve
  /// clients that join late. They have the same bytes, since both sides have the same state. Fails
  /// if `needs_key`, and where light comes as textures or by regions.
  Expected<std::vector<LightMessage>> join(std::uint64_t known_geometry = 0) const;
  /// The messages that LightEncoder::corrections would return, of the pieces received so far.
  std::vector<LightMessage> corrections() const;
  /// See LightEncoder::corrections_number.
  std::uint64_t corrections_number() const;
  /// Whether all pieces of the corrections were received; true where there are none.
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

/// A field whose light comes from a stream, with which a client renders its own copy of the world.
class StreamedField {
 public:
  explicit StreamedField(std::size_t most_bytes = std::size_t{1} << 30u);
  ~StreamedField();
  StreamedField(StreamedField&&) noexcept;
  StreamedField& operator=(StreamedField&&) noexcept;

  /// See LightDecoder::read_textures.
  void read_textures(std::unique_ptr<TextureReader> reader);

  /// Takes one message as LightDecoder::receive does, and brings the field up to date. Not to be
  /// called while the field is read.
  Expected<void> receive(std::span<const std::byte> message);
  const LightDecoder& decoder() const;

  /// The field, for Renderer and lookups, on the processor; null before the first key. The pointer
  /// stays valid afterwards. The field must not be updated, since its light is the server's.
  const IrradianceField* field() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lambent::stream
