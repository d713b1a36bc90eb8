// SPDX-License-Identifier: Apache-2.0
// The page that shows the picture stream in a browser.
#pragma once

#include <span>
#include <string_view>

namespace lambent::stream {

struct PageFile {
  std::string_view path;  ///< As it is asked for, such as "/page.js".
  std::string_view type;  ///< As the header Content-Type has it.
  std::string_view text;
};

/// All files of the page; the first one is "/".
std::span<const PageFile> page_files();

}  // namespace lambent::stream
