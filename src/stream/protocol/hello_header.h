// SPDX-License-Identifier: Apache-2.0
// A client's hello in the request that opens its WebSocket, which saves a round trip.
#pragma once

#include <string>
#include <string_view>

#include "lambent/error.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// The field of the request with the hello, and of the answer, where the server has taken it.
inline constexpr const char* kHelloField = "Lambent-Hello";
inline constexpr const char* kHelloTaken = "taken";

/// The message in hexadecimal digits.
std::string hello_header(const Hello& hello);
/// A client's message. Fails on what is none.
Expected<Message> read_hello_header(std::string_view digits);

}  // namespace lambent::stream
