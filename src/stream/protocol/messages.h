// SPDX-License-Identifier: Apache-2.0
// The messages between a server of light and its clients. docs/protocol.md has the layout of each
// message, its limits, and the consequences of violations. Independent of the transport.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent::stream {

/// Raised with every incompatible change.
inline constexpr std::uint32_t kProtocolVersion = 1;

// A type, three zeros, and the size of the rest.
inline constexpr std::size_t kHeaderBytes = 8;
/// Largest message of a client [bytes].
inline constexpr std::size_t kMaxClientMessageBytes = 512;
inline constexpr std::size_t kMaxTokenBytes = 256;
inline constexpr std::size_t kMaxErrorBytes = 512;
/// Largest access unit: that of the largest picture, barely compressed [bytes].
inline constexpr std::size_t kMaxPictureBytes = 8u << 20u;
/// Largest message of light: a key of a large field [bytes].
inline constexpr std::size_t kMaxLightBytes = 64u << 20u;
/// Maximum number of a scene's lights in a Welcome.
inline constexpr std::size_t kMaxToldLights = 256;
/// Range of a picture's sides [pixels].
inline constexpr std::uint32_t kMinPictureSide = 16, kMaxPictureSide = 4096;
/// Range of the rate that a client may request [pictures per second].
inline constexpr float kMinPictureRate = 0.1f, kMaxPictureRate = 120.0f;

/// What a client may do.
enum class Role : std::uint32_t { view = 1, change = 2 };

/// Flags of what a client requests and a server offers. Textures are light through H.265, in place
/// of Lambent's own codec.
inline constexpr std::uint32_t kWantsPicture = 1, kWantsLight = 2, kWantsTextures = 4;
inline constexpr std::uint32_t kWantsAll = kWantsPicture | kWantsLight | kWantsTextures;

// Messages of clients

/// The first message of each client.
struct Hello {
  std::uint32_t version = kProtocolVersion;
  std::uint32_t wants = kWantsPicture;
  glm::uvec2 size{640, 360};  ///< Size of the picture [pixels].
  float rate = 30.0f;         ///< Maximum pictures per second.
  std::string token;          ///< Empty: none.
};

/// Changes the size and the rate of pictures.
struct PictureRequest {
  glm::uvec2 size{640, 360};
  float rate = 30.0f;
};

// Inputs are numbered by the client, from 1; pictures have the number of the last one that they
// show.

/// The client's own camera; only clients send it. All of the following change the shared scene, and
/// the server sends the changes of others to clients of light, with `input` 0.
struct CameraInput {
  std::uint32_t input = 0;
  glm::vec3 position_ws{0.0f};                        ///< [m]
  glm::vec4 world_from_view{0.0f, 0.0f, 0.0f, 1.0f};  ///< Rotation, a unit quaternion x, y, z, w.
  float vertical_fov = 0.785398163f;                  ///< [rad]

  bool operator==(const CameraInput&) const = default;
};

/// Sets the time of day in the shared scene, which turns its first directional light.
struct TimeOfDay {
  std::uint32_t input = 0;
  float hours = 12.0f;  ///< 0 to 24; 12 is noon.
};

/// Sets the direction in which the light of the scene's first directional light travels.
struct SunInput {
  std::uint32_t input = 0;
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< Unit.
};

/// Flags of the numbers of a light that an edit replaces.
inline constexpr std::uint32_t kEditsPosition = 1, kEditsDirection = 2, kEditsIntensity = 4;

/// Changes a light of the shared scene.
struct LightInput {
  std::uint32_t input = 0;
  std::uint32_t light = 0;  ///< Index into Scene::lights.
  std::uint32_t edits = kEditsPosition;
  glm::vec3 position_ws{0.0f};                ///< [m]
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< Unit.
  glm::vec3 intensity{0.0f};                  ///< See Light::intensity.
};

/// Moves an object of the shared scene.
struct ObjectInput {
  std::uint32_t input = 0;
  std::uint32_t instance = 0;           ///< Index into Scene::instances.
  glm::mat4x3 world_from_object{1.0f};  ///< Affine.
};

/// Reports the last picture that the client has decoded, and its decoding time.
struct Received {
  std::uint32_t picture = 0;
  float decode_ms = 0.0f;
};

/// Reports the last message of light that the client has accepted, and whether it needs the whole
/// state.
struct LightReceived {
  std::uint64_t update = 0;     ///< LightPayload::update of that message.
  std::uint64_t geometry = 0;   ///< LightDecoder::geometry.
  std::uint32_t needs_key = 0;  ///< 1: LightDecoder::needs_key.
};

/// From now on, send light near the client's camera with each update, and the rest with every
/// eighth.
struct Interest {
  /// Everything within this distance is near, and everything in view within twice of it [m]; 0: all
  /// light is near.
  float radius = 0.0f;
};

// Messages of both

/// Must be sent back unchanged, marked as an answer.
struct Ping {
  std::uint64_t token = 0;
  std::uint32_t answer = 0;  ///< 1: this is an answer.
};

// Messages of the server

/// A light in a Welcome.
struct ToldLight {
  Light::Type type = Light::Type::point;
  glm::vec3 intensity{0.0f}, position_ws{0.0f}, direction_ws{0.0f, -1.0f, 0.0f};
};

/// The answer to Hello.
struct Welcome {
  std::uint32_t version = kProtocolVersion;
  Role role = Role::view;
  std::uint32_t offers = kWantsPicture;
  glm::uvec2 max_size{0};                ///< Largest size of pictures [pixels].
  float rate = 0.0f;                     ///< Updates of the light per second.
  CameraInput camera;                    ///< The client's camera until it is moved.
  glm::vec3 min_ws{0.0f}, max_ws{0.0f};  ///< Bounds of the scene [m].
  std::uint32_t instances = 0;
  std::vector<ToldLight> lights;
};

/// A picture of the client's camera.
struct Picture {
  std::uint32_t number = 0;  ///< Number among this client's pictures, from 1 on.
  std::uint32_t key = 0;     ///< 1: decoding can begin here.
  glm::uvec2 size{0};        ///< [pixels]
  std::uint64_t state = 0;   ///< Number of updates of the world that it shows.
  std::uint32_t input = 0;   ///< The client's last input that it shows; 0: none yet.
  float render_ms = 0.0f, encode_ms = 0.0f;
  std::vector<std::byte> bytes;  ///< An H.264 access unit, Annex B.
};

/// A payload of the light codec (lambent/stream.h).
struct LightPayload {
  std::uint32_t kind = 0;
  std::uint64_t update = 0;
  /// Time of the scene's animation in this light [s]; below 0: none is played.
  float time_s = -1.0f;
  std::vector<std::byte> bytes;
};

/// Tells a client of light which of its edits the light shows.
struct InputsApplied {
  std::uint32_t input = 0;   ///< The client's last input that was applied or refused, from 1.
  std::uint64_t update = 0;  ///< Light from this update on includes that input.
};

/// Statistics of the server, sent once a second.
struct ServerStats {
  std::uint64_t state = 0;
  float update_ms = 0.0f;  ///< Time of the last update of the light [ms].
  float rate = 0.0f;       ///< Achieved updates per second.
  std::uint32_t clients = 0;
  std::uint32_t bitrate = 0;   ///< Of this client's pictures [bit/s].
  float round_trip_ms = 0.0f;  ///< From sending a picture until the client's report.
};

/// Why the server refuses something. It then closes the connection, except after `refused_input`.
struct Refusal {
  enum class Code : std::uint32_t {
    bad_message = 1,    ///< Not parsed, or out of range.
    other_version = 2,  ///< Another version of the protocol.
    bad_token = 3,      ///< Unknown, expired or revoked.
    not_allowed = 4,    ///< The role does not allow it.
    refused_input = 5,  ///< There is no such light or object, or the scene would be invalid.
    too_many = 6,       ///< Too many clients, or messages per second.
    shutting_down = 7,  ///< The server ends.
    failed = 8,         ///< The server could not fulfil the request.
  };
  Code code = Code::bad_message;
  std::string text;  ///< UTF-8, for display.
};

using Message = std::variant<Hello, PictureRequest, CameraInput, TimeOfDay, SunInput, LightInput,
                             ObjectInput, Received, LightReceived, Interest, Ping, Welcome, Picture,
                             LightPayload, InputsApplied, ServerStats, Refusal>;

/// The sender of a message. Messages that only the other side may send are refused.
enum class Sender : std::uint8_t { client, server };

/// Writes a message as bytes. Its numbers must be in range, and its lists within their limits.
std::vector<std::byte> write_message(const Message& message);

/// Parses bytes that are exactly one message. Fails, naming the field, on types that the sender may
/// not send, on wrong sizes, and on numbers that are not finite or out of range.
Expected<Message> parse_message(std::span<const std::byte> bytes, Sender sender);

}  // namespace lambent::stream
