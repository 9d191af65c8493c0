// Base64 (RFC 4648), as data URIs and VTK's XML files hold bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scree {

std::string base64(std::string_view bytes);

// Nothing when `text` is not base64: a foreign letter, a length that is no multiple of four.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace scree
