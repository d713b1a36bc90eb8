// SPDX-License-Identifier: Apache-2.0
// What a server of light and its clients tell each other. docs/protocol.md has the layout of each
// message, its limits, and what happens to who violates them; nothing here knows of a transport.
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

/// Raised with every change that an older peer would not understand.
inline constexpr std::uint32_t kProtocolVersion = 1;

// A type, three zeros, and the size of what follows.
inline constexpr std::size_t kHeaderBytes = 8;
/// No message of a client is larger [bytes].
inline constexpr std::size_t kMaxClientMessageBytes = 512;
inline constexpr std::size_t kMaxTokenBytes = 256;
inline constexpr std::size_t kMaxErrorBytes = 512;
/// An access unit of the largest picture, barely compressed [bytes].
inline constexpr std::size_t kMaxPictureBytes = 8u << 20u;
/// A key of light of a large field [bytes].
inline constexpr std::size_t kMaxLightBytes = 64u << 20u;
/// Of a scene's lights a client is told the first of.
inline constexpr std::size_t kMaxToldLights = 256;
/// Pixels along an edge of a picture.
inline constexpr std::uint32_t kMinPictureSide = 16, kMaxPictureSide = 4096;
/// Pictures a second that a client may ask for.
inline constexpr float kMinPictureRate = 0.1f, kMaxPictureRate = 120.0f;

/// What a client may do.
enum class Role : std::uint32_t { view = 1, change = 2 };

/// What a client asks for, and a server offers: any of these, added.
/// Textures are light through H.265, in place of our own codec.
inline constexpr std::uint32_t kWantsPicture = 1, kWantsLight = 2, kWantsTextures = 4;
inline constexpr std::uint32_t kWantsAll = kWantsPicture | kWantsLight | kWantsTextures;

// Messages of clients

/// The first message of each client.
struct Hello {
  std::uint32_t version = kProtocolVersion;
  std::uint32_t wants = kWantsPicture;
  glm::uvec2 size{640, 360};  ///< Of the picture [pixels].
  float rate = 30.0f;         ///< Pictures a second, at most.
  std::string token;          ///< Empty: none.
};

/// How large pictures shall be from now on, and how many a second.
struct PictureRequest {
  glm::uvec2 size{640, 360};
  float rate = 30.0f;
};

// Inputs are numbered by the client, from 1; pictures tell the last one that they show.

/// Where the client's own camera is. Of clients alone; all that follow change the shared scene, and
/// the server tells clients of light what others have changed, as `input` 0.
struct CameraInput {
  std::uint32_t input = 0;
  glm::vec3 position_ws{0.0f};                        ///< [m]
  glm::vec4 world_from_view{0.0f, 0.0f, 0.0f, 1.0f};  ///< Rotation, a unit quaternion x, y, z, w.
  float vertical_fov = 0.785398163f;                  ///< [rad]
};

/// The time of day in the shared scene: turns its first directional light.
struct TimeOfDay {
  std::uint32_t input = 0;
  float hours = 12.0f;  ///< 0 to 24; 12 is noon.
};

/// The way that light of the scene's first directional light travels.
struct SunInput {
  std::uint32_t input = 0;
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< Unit.
};

/// Which numbers of a light an edit replaces: any of these, added.
inline constexpr std::uint32_t kEditsPosition = 1, kEditsDirection = 2, kEditsIntensity = 4;

/// New numbers of a light of the shared scene.
struct LightInput {
  std::uint32_t input = 0;
  std::uint32_t light = 0;  ///< Index into Scene::lights.
  std::uint32_t edits = kEditsPosition;
  glm::vec3 position_ws{0.0f};                ///< [m]
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< Unit.
  glm::vec3 intensity{0.0f};                  ///< As of Light::intensity.
};

/// Another place of an object of the shared scene.
struct ObjectInput {
  std::uint32_t input = 0;
  std::uint32_t instance = 0;           ///< Index into Scene::instances.
  glm::mat4x3 world_from_object{1.0f};  ///< Affine.
};

/// The last picture that the client has decoded, and how it fares.
struct Received {
  std::uint32_t picture = 0;
  float decode_ms = 0.0f;
};

/// The last message of light that the client has taken. Tells, too, where it must start again.
struct LightReceived {
  std::uint64_t update = 0;     ///< LightPayload::update of that message.
  std::uint64_t geometry = 0;   ///< LightDecoder::geometry.
  std::uint32_t needs_key = 0;  ///< 1: LightDecoder::needs_key.
};

/// From now on light near the client's camera comes with each update, and the rest every eighth.
struct Interest {
  float radius = 0.0f;  ///< Within this all is near, and what is seen within twice [m]; 0: all is.
};

// Messages of both

/// To be sent back as it is, marked as an answer.
struct Ping {
  std::uint64_t token = 0;
  std::uint32_t answer = 0;  ///< 1: it is one.
};

// Messages of the server

/// A light as clients are told of it.
struct ToldLight {
  Light::Type type = Light::Type::point;
  glm::vec3 intensity{0.0f}, position_ws{0.0f}, direction_ws{0.0f, -1.0f, 0.0f};
};

/// The answer to Hello.
struct Welcome {
  std::uint32_t version = kProtocolVersion;
  Role role = Role::view;
  std::uint32_t offers = kWantsPicture;
  glm::uvec2 max_size{0};                ///< Of pictures [pixels].
  float rate = 0.0f;                     ///< Updates of the light a second.
  CameraInput camera;                    ///< Where the client's camera stands until it is moved.
  glm::vec3 min_ws{0.0f}, max_ws{0.0f};  ///< Bounds of the scene [m].
  std::uint32_t instances = 0;
  std::vector<ToldLight> lights;
};

/// A picture of the client's camera.
struct Picture {
  std::uint32_t number = 0;  ///< Of this client's pictures, from 1 on.
  std::uint32_t key = 0;     ///< 1: decoding can begin here.
  glm::uvec2 size{0};        ///< [pixels]
  std::uint64_t state = 0;   ///< Updates of the world so far that it shows.
  std::uint32_t input = 0;   ///< The client's last input that it shows; 0: none yet.
  float render_ms = 0.0f, encode_ms = 0.0f;
  std::vector<std::byte> bytes;  ///< An H.264 access unit, Annex B.
};

/// A payload of the light codec (lambent/stream.h).
struct LightPayload {
  std::uint32_t kind = 0;
  std::uint64_t update = 0;
  /// Time of the scene's animation that the light is of [s]; below 0: none is played.
  float time_s = -1.0f;
  std::vector<std::byte> bytes;
};

/// Told to a client of light that has sent edits: which of them the light shows.
struct InputsApplied {
  std::uint32_t input = 0;   ///< The client's last input that was applied or refused, from 1.
  std::uint64_t update = 0;  ///< Light of this update and later ones is of the scene after it.
};

/// How the server fares, once a second.
struct ServerStats {
  std::uint64_t state = 0;
  float update_ms = 0.0f;  ///< Of the last update of the light.
  float rate = 0.0f;       ///< Updates a second, as reached.
  std::uint32_t clients = 0;
  std::uint32_t bitrate = 0;   ///< Of this client's pictures [bit/s].
  float round_trip_ms = 0.0f;  ///< From a picture that was sent to word of it.
};

/// Why the server refuses something. It closes the connection after all but `refused_input`.
struct Refusal {
  enum class Code : std::uint32_t {
    bad_message = 1,    ///< Not understood, or out of range.
    other_version = 2,  ///< Of the protocol.
    bad_token = 3,      ///< Unknown, expired or revoked.
    not_allowed = 4,    ///< The role does not allow it.
    refused_input = 5,  ///< There is no such light or object, or the scene cannot be so.
    too_many = 6,       ///< Clients, or messages a second.
    shutting_down = 7,  ///< The server ends.
    failed = 8,         ///< The server could not make what was asked for.
  };
  Code code = Code::bad_message;
  std::string text;  ///< UTF-8, for people.
};

using Message = std::variant<Hello, PictureRequest, CameraInput, TimeOfDay, SunInput, LightInput,
                             ObjectInput, Received, LightReceived, Interest, Ping, Welcome, Picture,
                             LightPayload, InputsApplied, ServerStats, Refusal>;

/// Who sends a message. Each refuses what only the other one may say.
enum class Sender : std::uint8_t { client, server };

/// A message in bytes. Its numbers must be in range, and its lists within their limits.
std::vector<std::byte> write_message(const Message& message);

/// The message that all of the bytes are. Fails, naming the field, on types that the sender does
/// not send, on sizes that do not agree, and on numbers that are not finite or out of range.
Expected<Message> parse_message(std::span<const std::byte> bytes, Sender sender);

}  // namespace lambent::stream
