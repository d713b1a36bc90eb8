// SPDX-License-Identifier: Apache-2.0
// Where a client's connection and the world meet: inputs one way, messages the other. Neither waits
// for the other, and what either leaves here is bounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stream/edits/edits.h"
#include "stream/pace/path_time.h"
#include "stream/protocol/messages.h"
#include "stream/server/rate_limit.h"

namespace lambent::stream {

/// A picture that a client has decoded.
struct Arrival {
  double round_trip_ms = 0.0;  ///< From when it was written until the client told of it.
  double path_ms = 0.0;        ///< Of that, while bytes were on their way (PathTime).
};

/// What a client sent since it was last asked.
struct ClientInputs {
  std::optional<CameraInput> camera;
  std::optional<PictureRequest> request;
  std::optional<Interest> interest;
  std::vector<Edit> edits;        ///< In their order; one a target.
  std::vector<Arrival> arrivals;  ///< Of pictures that the client has decoded since.
  /// The number of its last input; where edits wait, of the last one before these.
  std::uint32_t last_input = 0;
  bool any() const { return camera || request || !edits.empty(); }
};

/// A message that is written once for any number of clients.
using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// What a client of light is to be sent after an update.
enum class LightNeed : std::uint8_t {
  changes,  ///< It has all there was before.
  all,      ///< It has come late, has lost something, or was left out before.
  nothing,  ///< It does not keep up.
};

/// All functions may be called from any thread.
class ClientLink : public std::enable_shared_from_this<ClientLink> {
 public:
  /// Pictures that a client may have been sent without word of their arrival: one that travels and
  /// one that is decoded.
  static constexpr std::size_t kPicturesUnderWay = 2;
  /// The same of updates of light, those that wait to be written among them. More may be, as long
  /// as they have less than half the bytes of what the client was sent when it began: where a path
  /// has lost something, the updates that wait for it are there sooner than a beginning anew would
  /// be.
  static constexpr std::size_t kUpdatesUnderWay = 8, kMostUpdatesUnderWay = 64;
  /// Edits of different targets between two updates of the world.
  static constexpr std::size_t kMaxEdits = 64;
  /// Notices that wait for a connection; more means that it is stuck.
  static constexpr std::size_t kMaxNotices = 32;

  /// `wake_connection` is called whenever there is something to write, `wake_world` whenever there
  /// is something to do before its next update; neither may call back.
  ClientLink(Hello hello, Role role, std::function<void()> wake_connection,
             std::function<void()> wake_world);

  const Hello& hello() const { return hello_; }
  Role role() const { return role_; }
  bool wants(std::uint32_t what) const { return (hello_.wants & what) != 0; }
  /// In whichever codec.
  bool wants_light() const { return wants(kWantsLight | kWantsTextures); }

  // The connection's side

  /// Takes a message of the client's. What is returned is why the client must go: it sent what it
  /// may not, or too much. `path` is the connection's path time so far, for clients of pictures;
  /// none where it is not known.
  std::optional<Refusal> receive(const Message& message, Clock::time_point now,
                                 std::optional<PathTime> path = std::nullopt);
  /// What is to be written next, notices before light before the picture before what was put for
  /// later; null: nothing.
  SharedBytes next(Clock::time_point now, std::optional<PathTime> path = std::nullopt);
  /// The connection is gone; the world forgets the client.
  void leave();

  // The world's side

  bool gone() const;
  /// Edits wait for the next update of the world where they are not asked for.
  ClientInputs take_inputs(bool with_edits);
  /// Whether a picture may be made: none waits, and the client keeps up.
  bool ready_for_picture() const;
  /// A picture takes the place of one that waits, which there is none of if the world asked.
  void put_picture(const Picture& picture);
  /// What a client of light needs now; where that is nothing, it will need all later.
  LightNeed need_light();
  /// The number of the last geometry that the client has.
  std::uint64_t known_geometry() const;
  /// All messages that lead to an update: changes, or all.
  void put_light(std::span<const SharedBytes> messages, std::uint64_t update, LightNeed what);
  /// What is written only when nothing else is, after the light so far: corrections. `anew`: in
  /// place of what still waits of them.
  void put_later(std::span<const SharedBytes> messages, bool anew);
  /// Whether light has been put from its beginning, with all that follows it, and all is written.
  bool has_all() const;
  /// Updates are counted anew, from another stream: what waits is forgotten, and all is needed.
  void begin_light_anew();
  /// Something to tell, soon.
  void put_notice(const Message& message);
  /// Bytes that wait to be written.
  std::size_t waiting_bytes() const;

 private:
  struct UnderWay {
    std::uint32_t number = 0;
    std::optional<Clock::time_point> sent;
    std::optional<PathTime> path;  // when it was sent
  };
  struct LightUnderWay {
    std::uint64_t update = 0;
    std::size_t bytes = 0;  // of changes
  };
  bool is_late() const;
  std::optional<Refusal> take_edit(const Edit& edit);
  void take_received(const Received& received, Clock::time_point now, std::optional<PathTime> path);
  void take_light_received(const LightReceived& received);

  const Hello hello_;
  const Role role_;
  const std::function<void()> wake_connection_, wake_world_;

  mutable std::mutex mutex_;
  bool gone_ = false;
  ClientInputs inputs_;
  std::optional<std::uint32_t> first_edit_;  // the number of the first edit that waits
  std::deque<UnderWay> under_way_;
  std::optional<std::vector<std::byte>> picture_;
  std::uint32_t waiting_picture_ = 0;  // its number
  std::deque<std::vector<std::byte>> notices_;
  std::deque<SharedBytes> light_;
  std::deque<SharedBytes> later_;
  bool later_put_ = false;  // since light was put from its beginning
  std::deque<LightUnderWay> updates_under_way_;
  std::size_t whole_bytes_ = 0;  // of the last light that was sent from its beginning
  bool light_lost_ = true;       // changes would lead from what the client does not have
  std::uint64_t all_sent_at_ = 0, known_geometry_ = 0;
};

}  // namespace lambent::stream
