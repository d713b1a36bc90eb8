// SPDX-License-Identifier: Apache-2.0
// A client's Hello in the request that opens its WebSocket, which saves a round trip.
#pragma once

#include <string>
#include <string_view>

#include "lambent/error.h"
#include "stream/protocol/messages.h"

namespace lambent::stream {

/// The header field of the request with the Hello, and its value in the answer if the server has
/// accepted it.
inline constexpr const char* kHelloField = "Lambent-Hello";
inline constexpr const char* kHelloTaken = "taken";

/// The message in hexadecimal digits.
std::string hello_header(const Hello& hello);
/// Parses a client's message. Fails on invalid digits and messages.
Expected<Message> read_hello_header(std::string_view digits);

}  // namespace lambent::stream
