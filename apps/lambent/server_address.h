// SPDX-License-Identifier: Apache-2.0
// Parsing of server addresses, and reading of tokens.
#pragma once

#include <string>

#include "lambent/error.h"
#include "stream/client/client.h"

namespace lambent::cli {

/// "HOST", "HOST:PORT", either after http:// or https://, or nats://HOST[:PORT]/NAME, into `to`.
/// Parses a server's address into `to`. `option` is named in errors.
Expected<void> parse_server_address(const std::string& option, const std::string& address,
                                    stream::ConnectSettings& to);

/// Reads the token in a file; empty for the empty path.
Expected<std::string> read_token(const std::string& path);

}  // namespace lambent::cli
