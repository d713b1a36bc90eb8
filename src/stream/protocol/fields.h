// SPDX-License-Identifier: Apache-2.0
// The layout of each message, defined once for reading and writing: `fields` visits a message's
// numbers in order, with the range of each.
#pragma once

#include <numbers>

#include "stream/protocol/messages.h"

namespace lambent::stream {

/// "LMBT" as a little-endian word. It identifies the protocol, so that other data is refused.
inline constexpr std::uint32_t kMagic = 0x54424d4c;

// The ranges of Scene; see the comments of Light and Camera.
inline constexpr float kMaxPlace = 1e9f;       // [m]
inline constexpr float kMaxIntensity = 1e12f;  // [W/sr]
inline constexpr float kMaxScale = 1e10f;
inline constexpr float kMinFov = 0.001f, kMaxFov = std::numbers::pi_v<float> - 0.001f;  // [rad]
// Largest time in messages [ms]: an hour.
inline constexpr float kMaxMs = 3.6e6f;
inline constexpr float kMaxTime = 1e9f;  // of an animation [s]: 30 years
inline constexpr std::uint32_t kAnyWord = 0xffffffffu;

template <class Archive>
void fields(Archive& a, Hello& m) {
  std::uint32_t magic = kMagic;
  a.word("magic", magic, kMagic, kMagic);
  a.word("version", m.version, 0, kAnyWord);
  a.word("wants", m.wants, 1, kWantsAll);
  a.word("width", m.size.x, kMinPictureSide, kMaxPictureSide);
  a.word("height", m.size.y, kMinPictureSide, kMaxPictureSide);
  a.real("rate", m.rate, kMinPictureRate, kMaxPictureRate);
  a.text("token", m.token, kMaxTokenBytes);
}

template <class Archive>
void fields(Archive& a, PictureRequest& m) {
  a.word("width", m.size.x, kMinPictureSide, kMaxPictureSide);
  a.word("height", m.size.y, kMinPictureSide, kMaxPictureSide);
  a.real("rate", m.rate, kMinPictureRate, kMaxPictureRate);
}

template <class Archive>
void fields(Archive& a, CameraInput& m) {
  a.word("input", m.input, 0, kAnyWord);
  a.reals("position", m.position_ws, -kMaxPlace, kMaxPlace);
  a.unit("rotation", m.world_from_view);
  a.real("fov", m.vertical_fov, kMinFov, kMaxFov);
}

template <class Archive>
void fields(Archive& a, TimeOfDay& m) {
  a.word("input", m.input, 0, kAnyWord);
  a.real("hours", m.hours, 0.0f, 24.0f);
}

template <class Archive>
void fields(Archive& a, SunInput& m) {
  a.word("input", m.input, 0, kAnyWord);
  a.unit("direction", m.direction_ws);
}

template <class Archive>
void fields(Archive& a, LightInput& m) {
  a.word("input", m.input, 0, kAnyWord);
  a.word("light", m.light, 0, kAnyWord);
  a.word("edits", m.edits, 1, kEditsPosition | kEditsDirection | kEditsIntensity);
  a.reals("position", m.position_ws, -kMaxPlace, kMaxPlace);
  a.unit("direction", m.direction_ws);
  a.reals("intensity", m.intensity, 0.0f, kMaxIntensity);
}

template <class Archive>
void fields(Archive& a, ObjectInput& m) {
  a.word("input", m.input, 0, kAnyWord);
  a.word("instance", m.instance, 0, kAnyWord);
  for (int column = 0; column < 3; ++column) {
    a.reals("axes", m.world_from_object[column], -kMaxScale, kMaxScale);
  }
  a.reals("position", m.world_from_object[3], -kMaxPlace, kMaxPlace);
}

template <class Archive>
void fields(Archive& a, Received& m) {
  a.word("picture", m.picture, 0, kAnyWord);
  a.real("decode_ms", m.decode_ms, 0.0f, kMaxMs);
}

template <class Archive>
void fields(Archive& a, LightReceived& m) {
  a.long_word("update", m.update);
  a.long_word("geometry", m.geometry);
  a.word("needs_key", m.needs_key, 0, 1);
}

template <class Archive>
void fields(Archive& a, Interest& m) {
  a.real("radius", m.radius, 0.0f, kMaxPlace);
}

template <class Archive>
void fields(Archive& a, Ping& m) {
  a.long_word("token", m.token);
  a.word("answer", m.answer, 0, 1);
}

template <class Archive>
void fields(Archive& a, ToldLight& m) {
  auto type = static_cast<std::uint32_t>(m.type);
  a.word("light type", type, 0, static_cast<std::uint32_t>(Light::Type::spot));
  m.type = static_cast<Light::Type>(type);
  a.reals("intensity", m.intensity, 0.0f, kMaxIntensity);
  a.reals("position", m.position_ws, -kMaxPlace, kMaxPlace);
  a.unit("direction", m.direction_ws);
}

template <class Archive>
void fields(Archive& a, Welcome& m) {
  a.word("version", m.version, 0, kAnyWord);
  auto role = static_cast<std::uint32_t>(m.role);
  a.word("role", role, 1, static_cast<std::uint32_t>(Role::change));
  m.role = static_cast<Role>(role);
  a.word("offers", m.offers, 0, kWantsAll);
  a.word("max_width", m.max_size.x, kMinPictureSide, kMaxPictureSide);
  a.word("max_height", m.max_size.y, kMinPictureSide, kMaxPictureSide);
  a.real("rate", m.rate, 0.0f, 1e6f);
  fields(a, m.camera);
  a.reals("min", m.min_ws, -kMaxPlace, kMaxPlace);
  a.reals("max", m.max_ws, -kMaxPlace, kMaxPlace);
  a.word("instances", m.instances, 0, kAnyWord);
  a.list("lights", m.lights, kMaxToldLights);
}

template <class Archive>
void fields(Archive& a, Picture& m) {
  a.word("number", m.number, 1, kAnyWord);
  a.word("key", m.key, 0, 1);
  a.word("width", m.size.x, kMinPictureSide, kMaxPictureSide);
  a.word("height", m.size.y, kMinPictureSide, kMaxPictureSide);
  a.long_word("state", m.state);
  a.word("input", m.input, 0, kAnyWord);
  a.real("render_ms", m.render_ms, 0.0f, kMaxMs);
  a.real("encode_ms", m.encode_ms, 0.0f, kMaxMs);
  a.bytes("bytes", m.bytes, kMaxPictureBytes);
}

template <class Archive>
void fields(Archive& a, LightPayload& m) {
  a.word("kind", m.kind, 0, kAnyWord);
  a.long_word("update", m.update);
  a.real("time", m.time_s, -1.0f, kMaxTime);
  a.bytes("bytes", m.bytes, kMaxLightBytes);
}

template <class Archive>
void fields(Archive& a, InputsApplied& m) {
  a.word("input", m.input, 1, kAnyWord);
  a.long_word("update", m.update);
}

template <class Archive>
void fields(Archive& a, ServerStats& m) {
  a.long_word("state", m.state);
  a.real("update_ms", m.update_ms, 0.0f, kMaxMs);
  a.real("rate", m.rate, 0.0f, 1e6f);
  a.word("clients", m.clients, 0, kAnyWord);
  a.word("bitrate", m.bitrate, 0, kAnyWord);
  a.real("round_trip_ms", m.round_trip_ms, 0.0f, kMaxMs);
}

template <class Archive>
void fields(Archive& a, Refusal& m) {
  auto code = static_cast<std::uint32_t>(m.code);
  a.word("code", code, 1, static_cast<std::uint32_t>(Refusal::Code::failed));
  m.code = static_cast<Refusal::Code>(code);
  a.text("text", m.text, kMaxErrorBytes);
}

}  // namespace lambent::stream
