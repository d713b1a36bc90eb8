// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "stream/protocol/messages.h"

namespace lambent::test {

/// A message of each type, with lists that hold something, and who sends it.
inline std::vector<std::pair<stream::Message, stream::Sender>> one_of_each_message() {
  using namespace stream;
  const std::vector<std::byte> bytes(5, std::byte{9});
  Hello hello;
  hello.token = "a token that is secret";
  LightInput light;
  light.intensity = {1.0f, 2.0f, 3.0f};
  Welcome welcome;
  welcome.max_size = {1280, 720};
  welcome.lights.resize(2);
  Picture picture;
  picture.number = 1;
  picture.size = {64, 48};
  picture.bytes = bytes;
  const Refusal refusal{Refusal::Code::bad_token, "the token is not known here"};
  return {{hello, Sender::client},
          {PictureRequest{}, Sender::client},
          {CameraInput{}, Sender::client},
          {TimeOfDay{}, Sender::client},
          {SunInput{}, Sender::client},
          {light, Sender::client},
          {ObjectInput{}, Sender::client},
          {Received{1, 2.0f}, Sender::client},
          {LightReceived{3, 2, 1}, Sender::client},
          {Interest{4.0f}, Sender::client},
          {Ping{123, 0}, Sender::client},
          {welcome, Sender::server},
          {picture, Sender::server},
          {LightPayload{1, 2, 0.5f, bytes}, Sender::server},
          {InputsApplied{1, 2}, Sender::server},
          {ServerStats{}, Sender::server},
          {refusal, Sender::server}};
}

}  // namespace lambent::test
