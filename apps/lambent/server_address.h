// SPDX-License-Identifier: Apache-2.0
// Which server is meant, and what it asks for.
#pragma once

#include <string>

#include "lambent/error.h"
#include "stream/client/client.h"

namespace lambent::cli {

/// "HOST", "HOST:PORT", either after http:// or https://, or nats://HOST[:PORT]/NAME, into `to`.
/// `option` names the culprit in the error.
Expected<void> parse_server_address(const std::string& option, const std::string& address,
                                    stream::ConnectSettings& to);

/// The token that a file holds; empty for the empty path.
Expected<std::string> read_token(const std::string& path);

}  // namespace lambent::cli
