// SPDX-License-Identifier: Apache-2.0
// The queues between a client's connection and the world: inputs in one direction, messages in the
// other. Neither side waits for the other, and the queues are bounded.
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

/// Timing of a picture that a client has decoded.
struct Arrival {
  double round_trip_ms = 0.0;  ///< From writing the picture until the client's report.
  double path_ms = 0.0;        ///< Time of that in which bytes were in transit (PathTime).
};

/// The inputs of a client since the last call of take_inputs.
struct ClientInputs {
  std::optional<CameraInput> camera;
  std::optional<PictureRequest> request;
  std::optional<Interest> interest;
  std::vector<Edit> edits;        ///< In order; one per target.
  std::vector<Arrival> arrivals;  ///< Pictures that the client has decoded since.
  /// The number of its last input, or, if edits wait, of the last one before these.
  std::uint32_t last_input = 0;
  bool any() const { return camera || request || !edits.empty(); }
};

/// A message that is shared by any number of clients.
using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// The messages that a client of light needs after an update.
enum class LightNeed : std::uint8_t {
  changes,  ///< It has the state before the update.
  all,      ///< It joined late, has lost a message, or was skipped before.
  nothing,  ///< It does not keep up.
};

/// All functions may be called from any thread.
class ClientLink : public std::enable_shared_from_this<ClientLink> {
 public:
  /// Maximum number of pictures that were sent and not yet reported: one in transit and one that is
  /// decoded.
  static constexpr std::size_t kPicturesUnderWay = 2;
  /// Maximum number of updates of light that were sent or wait to be written, and not yet reported.
  /// Up to kMostUpdatesUnderWay are allowed while they have less than half the bytes of the whole
  /// state that the client was sent: after a loss on the path, these updates arrive sooner than a
  /// new whole state would.
  static constexpr std::size_t kUpdatesUnderWay = 8, kMostUpdatesUnderWay = 64;
  /// Maximum number of edits of different targets between two updates of the world.
  static constexpr std::size_t kMaxEdits = 64;
  /// Maximum number of queued notices; more mean that the connection is stuck.
  static constexpr std::size_t kMaxNotices = 32;

  /// `wake_connection` is called whenever there is something to write, `wake_world` whenever there
  /// is something to do before its next update; neither may call this object.
  ClientLink(Hello hello, Role role, std::function<void()> wake_connection,
             std::function<void()> wake_world);

  const Hello& hello() const { return hello_; }
  Role role() const { return role_; }
  bool wants(std::uint32_t what) const { return (hello_.wants & what) != 0; }
  /// With any codec.
  bool wants_light() const { return wants(kWantsLight | kWantsTextures); }

  // The connection's side

  /// Takes a message of the client. Returns a refusal if the client must be disconnected, since the
  /// message is not allowed or it has sent too many. `path` is the connection's path time so far,
  /// for clients of pictures; none where it is not known.
  std::optional<Refusal> receive(const Message& message, Clock::time_point now,
                                 std::optional<PathTime> path = std::nullopt);
  /// The next message to write, by priority: notices, light, the picture, messages of put_later;
  /// null: none.
  SharedBytes next(Clock::time_point now, std::optional<PathTime> path = std::nullopt);
  /// Reports that the connection has ended; the world then drops the client.
  void leave();

  // The world's side

  bool gone() const;
  /// Takes the client's inputs. Without `with_edits`, edits remain queued for the next update of
  /// the world.
  ClientInputs take_inputs(bool with_edits);
  /// Whether a picture may be rendered: none is queued, and the client keeps up.
  bool ready_for_picture() const;
  /// Queues a picture. It replaces a queued one, which does not exist after ready_for_picture().
  void put_picture(const Picture& picture);
  /// The messages that a client of light needs now; after `nothing`, it will need `all`.
  LightNeed need_light();
  /// The number of the last geometry that the client has.
  std::uint64_t known_geometry() const;
  /// Queues all messages that lead to an update: changes, or the whole state.
  void put_light(std::span<const SharedBytes> messages, std::uint64_t update, LightNeed what);
  /// Queues messages of the lowest priority, which follow the light so far: corrections. `anew`:
  /// they replace those that are still queued.
  void put_later(std::span<const SharedBytes> messages, bool anew);
  /// Whether the whole state of light and its corrections were queued, and all is written.
  bool has_all() const;
  /// Starts another stream, whose updates are counted anew: queued light is dropped, and the whole
  /// state is needed.
  void begin_light_anew();
  /// Queues a notice.
  void put_notice(const Message& message);
  /// Number of queued bytes.
  std::size_t waiting_bytes() const;

 private:
  struct UnderWay {
    std::uint32_t number = 0;
    std::optional<Clock::time_point> sent;
    std::optional<PathTime> path;  // path time when it was sent
  };
  struct LightUnderWay {
    std::uint64_t update = 0;
    std::size_t bytes = 0;  // bytes of changes
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
  std::optional<std::uint32_t> first_edit_;  // number of the first queued edit
  std::deque<UnderWay> under_way_;
  std::optional<std::vector<std::byte>> picture_;
  std::uint32_t waiting_picture_ = 0;  // number of picture_
  std::deque<std::vector<std::byte>> notices_;
  std::deque<SharedBytes> light_;
  std::deque<SharedBytes> later_;
  bool later_put_ = false;  // since the whole state was queued
  std::deque<LightUnderWay> updates_under_way_;
  std::size_t whole_bytes_ = 0;  // size of the last whole state
  bool light_lost_ = true;       // changes would not apply to the client's state
  std::uint64_t all_sent_at_ = 0, known_geometry_ = 0;
};

}  // namespace lambent::stream
